# SPDX-License-Identifier: BSD-3-Clause
import unittest

from prf_experiments.run import connections, names


class FakeMaster:
    def __init__(self, publishers, subscribers):
        self._state = [publishers, subscribers, []]

    def getSystemState(self):
        return self._state


class Links(unittest.TestCase):
    def test_pairs_every_subscriber_with_every_publisher_but_itself(self):
        master = FakeMaster([["/tf", ["/a", "/b"]]], [["/tf", ["/b", "/c"]], ["/none", ["/c"]]])
        self.assertEqual(connections.registered(master),
                         {("/tf", "/a", "/b"), ("/tf", "/a", "/c"), ("/tf", "/b", "/c")})

    def test_trial_cannot_do_without_the_loop(self):
        links = connections.trial_links("platform_sim")
        self.assertIn(("/joint_command", "/arm_controller", "/platform_sim"), links)
        self.assertIn(("/camera/image_raw", "/platform_sim", "/tag_detector"), links)
        self.assertFalse(any(topic.startswith("/ground_truth") for topic, _, _ in links))

    def test_replay_has_no_simulator(self):
        links = connections.trial_links("player", simulated=False)
        self.assertFalse(any("/platform_sim" in link for link in links))
        self.assertIn(("/joint_states", "/player", "/decision"), links)

    def test_with_a_driver_joiner_and_adapter_are_in_the_loop(self):
        links = connections.through_driver({("/joint_states", "/platform_sim", "/recorder"),
                                            ("/camera/image_raw", "/platform_sim", "/recorder")},
                                           "platform_sim")
        self.assertIn(("/joint_states", "/joint_state_joiner", "/recorder"), links)
        self.assertIn(("/camera/image_raw", "/platform_sim", "/recorder"), links)
        self.assertIn(("/joint_command", "/arm_controller", "/driver_adapter"), links)

    def test_the_tick_is_the_drivers(self):
        self.assertEqual(names.driver_period(""), 0.01)
        self.assertEqual(names.driver_period("kortex"), 0.025)
        self.assertIn("kinova", names.driver_names())


if __name__ == "__main__":
    unittest.main()
