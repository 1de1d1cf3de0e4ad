#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The recorder loses no message, closes its bag on SIGINT, and says when it cannot write."""
import os
import random
import resource
import shutil
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
        folder = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        self.addCleanup(folder.cleanup)
        self.bag = os.path.join(folder.name, "numbers.bag")

    def start(self, *arguments, before=()):
        process = subprocess.Popen([*before, RECORDER, *arguments, "__name:=recorder_under_test"],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        return process

    def check_failure(self, recorder, reason):
        said = recorder.communicate(timeout=20.0)[1]
        self.assertEqual(recorder.returncode, 1, said)
        self.assertRegex(said, "cannot be written: " + reason)
        self.assertFalse(os.path.exists(self.bag))

    def wait_until(self, condition, what):
        end = time.monotonic() + 20.0
        while not condition():
            self.assertLess(time.monotonic(), end, what)
            time.sleep(0.02)

    def test_records_every_message_of_a_burst(self):
        recorder = self.start("--lz4", self.bag, "/numbers")
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

    # Fault 35, 49: the disk is full while the bag is written -> the recorder says so and ends with code 1
    def test_ends_with_its_exit_code_when_the_disk_is_full(self):
        recorder = self.start(self.bag, "/numbers")
        self.wait_until(lambda: self.publisher.get_num_connections() == 1, "no subscriber")
        resource.prlimit(recorder.pid, resource.RLIMIT_FSIZE, (0, resource.RLIM_INFINITY))
        filling = "".join(random.Random(1).choices(string.printable, k=SIZE))
        for number in range(COUNT):
            self.publisher.publish(f"{number} {filling}")
        self.check_failure(recorder, "")

    # Fault 35: little is left of the disk -> it ends before the disk is full and says what is left
    def test_ends_when_the_disk_is_nearly_full(self):
        folder = os.path.dirname(self.bag)
        small = ("unshare", "--map-root-user", "--mount", "sh", "-c",
                 f'mount -t tmpfs -o size=8m none {folder} && exec "$@"', "sh")
        if subprocess.run([*small, "true"], stderr=subprocess.DEVNULL, check=False).returncode:
            self.skipTest("no file system may be mounted here")
        self.check_failure(self.start(self.bag, "/numbers", before=small),
                           r"the disk is full: \d MiB left, at least 64 needed")

    # Fault 49: the folder of the bag vanishes -> the recorder says so and ends with code 1
    def test_ends_when_its_folder_vanishes(self):
        recorder = self.start(self.bag, "/numbers")
        self.wait_until(lambda: os.path.exists(self.bag + ".active"), "no bag is open")
        shutil.rmtree(os.path.dirname(self.bag))
        self.check_failure(recorder, "the file or its folder has vanished")

    def test_needs_a_bag_and_a_topic(self):
        self.assertEqual(self.start(self.bag).wait(20.0), 2)


if __name__ == "__main__":
    rostest.rosrun("prf_ros", "recorder", Recorder)
