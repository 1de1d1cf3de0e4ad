# SPDX-License-Identifier: BSD-3-Clause
"""What the latency command makes of the times of messages."""
import unittest

from prf_experiments.run import latency

MS = 1_000_000  # ns


class LatencyTest(unittest.TestCase):
    def made_up(self):
        events = latency.Events()
        for tick in range(4):
            for late, topic in enumerate(latency.TICKS):
                events.add(topic, 10 * tick * MS, 0.010 * tick + 0.001 * late)
        for late, topic in enumerate(latency.IMAGES):
            events.add(topic, 3 * MS, 0.004 * late)
        events.forecast_of.update({10 * MS: 3 * MS, 20 * MS: 3 * MS})
        events.add(latency.PLANS, 10 * MS, 0.0155)
        return events

    # Fault 50: chain late under load -> each hop is measured, from image to the command using it
    def test_hops_are_between_messages_of_one_stamp(self):
        hops = {latency.key(hop): row for hop, row in latency.hops(self.made_up()).items()}
        self.assertEqual(len(hops["joint_states_to_joint_command"]), 4)
        for row in hops["joint_states_to_joint_command"]:
            self.assertAlmostEqual(row, 0.003)
        self.assertAlmostEqual(hops["image_to_first_joint_command_that_uses_it"][0], 0.013)
        self.assertAlmostEqual(hops["target_forecast_to_first_execution_progress"][0], 0.003)
        self.assertAlmostEqual(hops["execution_progress_to_skill_trajectory"][0], 0.0045)

    def test_what_never_came_is_no_hop(self):
        events = self.made_up()
        events.times["joint_command"].clear()
        hops = latency.hops(events)
        self.assertEqual(hops["joint_states to joint_command"], [])
        self.assertEqual(latency.summary([])["count"], 0)

    def test_a_message_that_comes_twice_counts_once(self):
        events = latency.Events()
        events.add("joint_states", 0, 1.0)
        events.add("joint_states", 0, 2.0)
        self.assertEqual(events.times["joint_states"], {0: 1.0})


if __name__ == "__main__":
    unittest.main()
