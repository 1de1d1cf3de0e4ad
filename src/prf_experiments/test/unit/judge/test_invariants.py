# SPDX-License-Identifier: BSD-3-Clause
import os
import sys
import unittest

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(__file__), ".."))
import synthetic
from prf_experiments.judge import invariants, judge, reaction
from prf_experiments.record import recording
from prf_experiments.record.recording import FaultEvent, Joints

from prf_experiments import robots

DT = 1e-9 * recording.TICK
LIMITS = invariants.Limits(np.full(7, -2.0), np.full(7, 2.0), np.full(7, 0.6), 4.0, 0.2)


def moving(seconds=4.0):
    """A trial whose first joint speeds up, goes and stops, within all limits."""
    data = synthetic.make_recording(seconds)
    count = len(data.ticks)
    speed = np.clip(np.minimum(0.04 * np.arange(count), 0.04 * np.arange(count)[::-1]), 0.0, 0.5)
    velocities = np.zeros((count, 7))
    velocities[:, 0] = speed
    positions = np.cumsum(velocities, axis=0) * DT
    data.commands = Joints(data.ticks.copy(), positions, velocities)
    data.measured = Joints(data.ticks.copy(), positions - 0.02 * velocities, velocities.copy())
    return data


class Invariants(unittest.TestCase):
    def broken(self, data):
        return invariants.check(data, LIMITS).violations

    def test_hold_for_a_motion_within_its_limits(self):
        found = invariants.check(moving(), LIMITS)
        self.assertEqual(found.violations, [])
        self.assertAlmostEqual(found.figures["largest_acceleration_share"], 1.0)
        self.assertAlmostEqual(found.figures["largest_joint_step_rad"], 0.005)

    def test_the_packages_limits_can_be_read(self):
        found = invariants.limits(robots.load())
        self.assertEqual(found.acceleration, 4.0)
        self.assertTrue(np.all(found.velocity > 0.5))
        self.assertTrue(np.isinf(found.upper[0]) and np.isfinite(found.upper[1]))

    def test_each_is_told_with_joint_time_and_value(self):
        def step(data):
            data.commands.positions[200:, 3] += 0.1

        def far(data):
            data.measured.positions[200, 2] -= 0.4

        def acceleration(data):
            data.commands.velocities[200, 1] = 0.3

        def velocity(data):
            data.commands.velocities[200, 1] = 0.61

        def beyond(data):
            data.commands.positions[:, 4] = data.measured.positions[:, 4] = 1.0
            data.commands.positions[200:, 4] = 2.01

        def infinite(data):
            data.commands.positions[200, 5] = np.nan

        def gap(data):
            keep = np.delete(np.arange(len(data.ticks)), slice(150, 180))
            data.commands = Joints(*(values[keep] for values in (
                data.commands.stamps, data.commands.positions, data.commands.velocities)))
        for change, joint, told in (
                (step, 4, "step beyond"), (far, 3, "too far from the measured"),
                (acceleration, 2, "acceleration beyond"), (velocity, 2, "velocity beyond"),
                (beyond, 5, "position beyond"), (infinite, 6, "not finite")):
            data = moving()
            change(data)
            found = self.broken(data)
            self.assertTrue(any(told in text and f"joint {joint} at 2.00 s" in text
                                for text in found), found)
        data = moving()
        gap(data)
        self.assertTrue(any("breaks off at 1.49 s" in text for text in self.broken(data)))

    # Fault 26: a node is killed and started again -> the first command after it is at the arm
    def test_after_a_gap_the_command_begins_at_the_measured_joints(self):
        for away, wrong in ((0.0, False), (0.05, True)):
            data = moving()
            data.description = {"arguments": {"fault": "respawn/arm_controller"}}
            data.commands.velocities[:] = 0.0
            data.measured.positions[:] = 0.5
            data.commands.positions[:200] = 0.5
            data.commands.positions[200:] = 0.5 + away
            data.commands.stamps[200:] += 30 * recording.TICK
            data.measured = Joints(data.commands.stamps, data.measured.positions,
                                   data.measured.velocities)
            self.assertEqual(any("first one after a gap" in text for text in self.broken(data)),
                             wrong)

    def test_a_joint_that_turns_without_end_may_be_in_another_turn(self):
        data = moving()
        data.measured.positions[:, 0] += 2.0 * np.pi
        self.assertEqual(self.broken(data), [])

    def test_a_process_that_is_left_over_is_told(self):
        found = invariants.check(moving(), LIMITS, ["decision_node __name:=decision"])
        self.assertIn("process left over: decision_node", found.violations[0])


class Reaction(unittest.TestCase):
    def test_tells_when_the_execution_held_and_when_it_went_on(self):
        data = moving(8.0)
        state = judge.STATES.index
        data.progress.states[:] = state("FORWARD")
        data.progress.states[310:420] = state("PAUSE")
        data.fault_events = [FaultEvent(int(data.ticks[row]), "drop/tf", "") for row in (300, 305)]
        found = reaction.times(data)
        self.assertAlmostEqual(found["fault_begin_s"], 3.0)
        self.assertAlmostEqual(found["time_to_hold_s"], 0.1)
        self.assertAlmostEqual(found["time_to_recover_s"], 1.1)
        data.progress.states[310:] = state("STOPPED")
        self.assertIsNone(reaction.times(data)["time_to_recover_s"])

    def test_events_close_to_each_other_are_one_episode(self):
        data = moving(8.0)
        data.fault_events = [FaultEvent(int(data.ticks[row]), "drop/tf", "") for row in
                             (100, 110, 120, 300)] + [FaultEvent(int(data.ticks[200]), "disk", "x")]
        self.assertEqual([(fault, count, told) for fault, _, _, count, told
                          in reaction.episodes(data)],
                         [("drop/tf", 3, []), ("disk", 1, ["x"]), ("drop/tf", 1, [])])


if __name__ == "__main__":
    unittest.main()
