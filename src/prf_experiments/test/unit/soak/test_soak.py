# SPDX-License-Identifier: BSD-3-Clause
import os
import sys
import tempfile
import unittest

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(__file__), ".."))
import synthetic
from prf_experiments.judge import judge
from prf_experiments.record.recording import Contact, FaultEvent
from prf_experiments.soak import measures, schedule, soak


class Schedule(unittest.TestCase):
    def test_the_seed_decides_and_the_begin_and_the_end_are_without_faults(self):
        faults = schedule.draw(3, 3600.0)
        self.assertEqual(faults, schedule.draw(3, 3600.0))
        self.assertNotEqual(faults, schedule.draw(4, 3600.0))
        self.assertGreater(len(faults), 80)
        self.assertGreaterEqual(faults[0].begin, 20.0)
        self.assertLess(faults[-1].begin, 3570.0)
        for fault, following in zip(faults, faults[1:]):
            self.assertGreater(following.begin - fault.begin, 10.0)

    def test_every_kind_is_drawn(self):
        names = {fault.name for seed in range(5) for fault in schedule.draw(seed, 3600.0)}
        for name in ("respawn", "stop", "old", "ahead", "drop", "false_tag", "nan", "foreign_tf"):
            self.assertIn(name, names)


class Measures(unittest.TestCase):
    def test_memory_that_fills_at_first_does_not_grow_and_a_leak_does(self):
        times = np.arange(0.0, 3600.0, 5.0)
        filling = 50.0 - 20.0 * np.exp(-times / 100.0)
        leaking = 50.0 + times / 3600.0 * 10.0
        rows = measures.memory({"still": [(float(t), float(m), 7) for t, m in zip(times, filling)],
                                "leak": [(float(t), float(m), 8) for t, m in zip(times, leaking)]})
        leak, still = rows
        self.assertTrue(measures.grows(leak))
        self.assertAlmostEqual(leak["growth_mb_per_h"], 10.0, places=6)
        self.assertFalse(measures.grows(still), still)

    def test_of_a_node_that_was_started_again_the_longest_life_counts(self):
        samples = [(float(t), 10.0 if t < 50 else 30.0, 1 if t < 50 else 2) for t in range(200)]
        row = measures.memory({"decision": samples})[0]
        self.assertEqual((row["lives_count"], row["first_mb"], row["observed_s"]), (2, 30.0, 149.0))

    def test_a_recovery_is_counted_and_a_missing_one_too(self):
        data = synthetic.make_recording(40.0)
        state = judge.STATES.index
        data.progress.states[:] = state("FORWARD")
        data.progress.states[500:600] = data.progress.states[2000:] = state("PAUSE")
        data.fault_events = [FaultEvent(int(data.ticks[row]), fault, "")
                             for row, fault in ((500, "respawn/decision"), (2000, "flip"))]
        executing = np.ones(len(data.ticks), dtype=bool)
        first, second = measures.recoveries(data, executing)
        self.assertAlmostEqual(first["recovered_s"], 1.0)
        self.assertIsNone(second["recovered_s"])
        self.assertFalse(second["idle"])
        self.assertTrue(measures.recoveries(data, ~executing)[1]["idle"])

    def test_what_is_not_right_is_told(self):
        data = synthetic.make_recording(40.0)
        data.contacts = [Contact(int(data.ticks[300]), ("box", "j2s7s300_link_7"), 60.0)]
        watch = soak.Watch("/nowhere", None, None)
        summary = soak.evaluate(data, watch, [], 60.0, ["decision_node"])
        told = soak.text(summary)
        self.assertIn("NOT RIGHT: process left over: decision_node", told)
        self.assertIn("NOT RIGHT: no execution came to an end", told)
        self.assertIn("NOT RIGHT: contact above 50 N at 3.00 s (box with", told)
        self.assertIn("NOT RIGHT: the run ended after 40.0 of 60 s", told)

    def test_the_page_begins_with_a_sentence_and_what_is_not_right(self):
        summary = {"simulated_s": 90.0, "executions": {"DONE": 3, "LOST": 1}, "failures": [], "memory": [],
                   "forecast_error_median_mm": [], "recoveries": [
                       {"fault": "a", "at_s": 1.0, "idle": False, "recovered_s": 2.5},
                       {"fault": "b", "at_s": 2.0, "idle": False, "recovered_s": None},
                       {"fault": "c", "at_s": 3.0, "idle": True, "recovered_s": None}]}
        said = "In 1.5 min 4 executions and 2 faults while one was asked for, recovered from 1 after at most 2.5 s; "
        self.assertEqual(soak.conclusion(summary), said + "nothing is wrong.")
        summary["failures"] = ["no recovery <b>"]
        self.assertEqual(soak.conclusion(summary), said + "1 thing is NOT RIGHT, listed below.")
        with tempfile.TemporaryDirectory() as folder:
            soak.write(folder, "a command", summary, soak.Watch("/nowhere", None, None))
            with open(os.path.join(folder, "index.html"), encoding="utf-8") as stream:
                page = stream.read()
        self.assertLess(page.index("<td>no recovery &lt;b&gt;</td>"), page.index("<h2>Memory</h2>"))
        self.assertIn('<tr><td>LOST</td><td class="number">1</td></tr>', page)


if __name__ == "__main__":
    unittest.main()
