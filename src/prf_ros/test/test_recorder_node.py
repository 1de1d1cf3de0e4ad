#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The recorder loses no message, closes its bag on SIGINT, and says when it cannot write."""
import os
import random
import resource
import signal
import string
import subprocess
import tempfile
import time
import unittest

import rosbag
import roslib.packages
import rospy
import rostest
from std_msgs.msg import String

RECORDER = roslib.packages.find_node("prf_ros", "recorder")[0]
COUNT = 3000  # in one burst; `rosbag record` keeps 100 that wait
SIZE = 30_000  # characters of each, which the recorder needs longer to compress than to receive


class Recorder(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("recorder_test")
        cls.publisher = rospy.Publisher("numbers", String, queue_size=2 * COUNT)

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.bag = os.path.join(folder.name, "numbers.bag")

    def start(self, *arguments):
        process = subprocess.Popen([RECORDER, *arguments, "__name:=recorder_under_test"],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def wait_until(self, condition, what):
        end = time.monotonic() + 20.0
        while not condition():
            self.assertLess(time.monotonic(), end, what)
            time.sleep(0.02)

    def test_records_every_message_of_a_burst(self):
        recorder = self.start(self.bag, "/numbers")
        self.wait_until(lambda: self.publisher.get_num_connections() == 1, "no subscriber")
        filling = "".join(random.Random(1).choices(string.printable, k=SIZE))
        for number in range(COUNT):
            self.publisher.publish(f"{number} {filling}")
        self.wait_until(lambda: os.path.exists(self.bag + ".active"), "no bag is open")
        self.assertFalse(os.path.exists(self.bag))
        time.sleep(3.0)  # the burst arrives
        recorder.send_signal(signal.SIGINT)
        self.assertEqual(recorder.wait(20.0), 0)
        self.assertFalse(os.path.exists(self.bag + ".active"))
        with rosbag.Bag(self.bag) as bag:
            numbers = [int(message.data.split(" ", 1)[0])
                       for _, message, _ in bag.read_messages("/numbers")]
            self.assertEqual(bag.get_compression_info().compression, "lz4")
        self.assertEqual(numbers, list(range(COUNT)))

    def test_says_by_its_exit_code_that_it_cannot_write(self):
        recorder = self.start(os.path.join(self.bag, "in_no_folder.bag"), "/numbers")
        self.assertEqual(recorder.wait(20.0), 1)

    # Fault 35, 49, A8: the disk is full while the bag is written -> the recorder says so and ends with code 1
    def test_ends_with_its_exit_code_when_the_disk_is_full(self):
        recorder = subprocess.Popen(
            [RECORDER, self.bag, "/numbers", "__name:=recorder_under_test"], text=True,
            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
            preexec_fn=lambda: signal.signal(signal.SIGXFSZ, signal.SIG_IGN))
        self.addCleanup(recorder.kill)
        self.wait_until(lambda: self.publisher.get_num_connections() == 1, "no subscriber")
        resource.prlimit(recorder.pid, resource.RLIMIT_FSIZE, (0, resource.RLIM_INFINITY))
        filling = "".join(random.Random(1).choices(string.printable, k=SIZE))
        for number in range(COUNT):
            self.publisher.publish(f"{number} {filling}")
        self.assertIn("cannot be written", recorder.communicate(timeout=20.0)[1])
        self.assertEqual(recorder.returncode, 1)
        self.assertFalse(os.path.exists(self.bag))

    def test_needs_a_bag_and_a_topic(self):
        self.assertEqual(self.start(self.bag).wait(20.0), 2)


if __name__ == "__main__":
    rostest.rosrun("prf_ros", "recorder", Recorder)
