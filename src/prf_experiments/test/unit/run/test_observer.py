# SPDX-License-Identifier: BSD-3-Clause
import threading
import unittest

from prf_experiments.run import observer


class ObserverTest(unittest.TestCase):
    def test_the_loop_of_a_closed_node_ends_and_takes_no_processor(self):
        server = observer.rosgraph.xmlrpc.ThreadingXMLRPCServer(("127.0.0.1", 0))
        loop = threading.Thread(target=server.serve_forever, daemon=True)
        loop.start()
        server.socket.close()  # as rospy does
        closing = threading.Thread(target=server.server_close, daemon=True)
        closing.start()
        closing.join(5.0)
        loop.join(5.0)
        self.assertFalse(loop.is_alive())


if __name__ == "__main__":
    unittest.main()
