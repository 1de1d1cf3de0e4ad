# SPDX-License-Identifier: BSD-3-Clause
import os
import re
import sys
import tempfile
import unittest
from html.parser import HTMLParser

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(__file__), ".."))
import synthetic
from prf_experiments.judge import invariants, judge, reaction
from prf_experiments.record import recording
from prf_experiments.report import measures, page, pictures, report
from prf_experiments.teach import demonstration

from prf_experiments import geometry, robots

VOID = {"meta", "br", "hr", "img"}
SKILL = demonstration.make(
    0.1 * np.arange(20), np.hstack([np.linspace([0.4, -0.2, 0.4], [0.6, 0.0, 0.6], 20),
                                    np.tile([0, 0, 0, 1.0], (20, 1))]), geometry.IDENTITY, "test", robots.load())


class Balance(HTMLParser):
    """Collects elements that are not closed in order, and everything that is fetched."""

    def __init__(self):
        super().__init__()
        self.open, self.wrong, self.fetched = [], [], []

    def handle_starttag(self, tag, attributes):
        if tag not in VOID:
            self.open.append(tag)
        self.fetched += [value for name, value in attributes
                         if name in ("src", "href", "xlink:href") and not value.startswith("#")]

    def handle_startendtag(self, tag, attributes):
        self.handle_starttag(tag, attributes)
        if tag not in VOID:
            self.open.pop()

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.wrong.append(tag)


class Report(unittest.TestCase):
    def write(self, data, verdict=None, brief=False):
        with tempfile.TemporaryDirectory() as folder:
            bag, out = os.path.join(folder, "trial.bag"), os.path.join(folder, "report.html")
            synthetic.write_bag(bag, data)
            read = recording.read(bag)
            content = {**(verdict or judge.judge(read)).as_json(), "command": "run <this> & that",
                       "arguments": {"seed": 1},
                       "cause": "The cart <moved>.", "versions": {"python": "3"}, "wall_time_s": 4.2}
            if brief:
                report.write_brief(out, bag, read, content)
            else:
                report.write(out, bag, read, content, SKILL)
            with open(out, encoding="utf-8") as stream:
                return stream.read()

    def test_in_brief_has_words_and_numbers_and_says_how_it_is_drawn(self):
        text = self.write(synthetic.make_recording(3.0), brief=True)
        self.assertEqual((text.count("data-plot="), text.count("<img")), (0, 0))
        for part in ("run &lt;this&gt; &amp; that", "Timeline", "Figures of merit", "Not drawn"):
            self.assertIn(part, text)

    def assert_sound(self, text):
        parser = Balance()
        parser.feed(text)
        self.assertEqual((parser.open, parser.wrong, parser.fetched), ([], [], []))

    def test_is_one_page_that_fetches_nothing(self):
        data = synthetic.make_recording(3.0)
        data.detections[10:20] = np.nan
        data.contacts = [recording.Contact(int(data.ticks[150]), ("box_back", "camera_link"), 2.5)]
        text = self.write(data)
        self.assert_sound(text)
        self.assertEqual(len(re.findall('<div class="plots"', text)), 5)
        self.assertIn("run &lt;this&gt; &amp; that", text)
        self.assertIn("partial success", text)
        self.assertIn("box_back | camera_link", text)
        for phase in ("FORWARD", "TRACKING", "DONE"):
            self.assertIn(phase, text)

    def test_draws_a_trial_whose_target_was_never_seen_or_forecast(self):
        data = synthetic.make_recording(61.0, lateral=0.3, state="WAITING")
        data.detections[:] = np.nan
        data.forecasts.horizons = [np.array([])] * len(data.detection_stamps)
        data.forecasts.positions = [np.empty((0, 3))] * len(data.detection_stamps)
        text = self.write(data)
        self.assert_sound(text)
        self.assertIn("failure", text)

    def test_says_why_there_is_no_evidence(self):
        text = self.write(synthetic.make_recording(1.0), judge.invalid("the recorder <died>"))
        self.assert_sound(text)
        self.assertIn("no evidence: the recorder &lt;died&gt;", re.sub("<[^>]*>", "", text))

    def test_shows_the_scene_and_the_parameters_of_the_nodes(self):
        content = judge.invalid("cut").as_json()
        text = report.render(content, None, [], page.Markup("<p>a picture</p>"),
                             "decision: {lead: <0.02>}")
        self.assert_sound(text)
        self.assertIn("<h2>Scene</h2>\n<p>a picture</p>", text)
        self.assertIn("decision: {lead: &lt;0.02&gt;}", text)

    def test_says_what_came_out_why_and_what_it_means(self):
        text = re.sub("<[^>]*>", "", self.write(synthetic.make_recording(4.0), brief=True))
        for part in ("Inspected: within 40 mm for 2.0 s by 2.00 s.", "Why The cart &lt;moved&gt;.",
                     "tag off the optical axis, at the end", "Reached, with an issue"):
            self.assertIn(part, text)
        self.assertNotIn("final_lateral_mm", text)

    def test_begins_with_the_verdict_and_the_rules_and_fits_a_phone(self):
        text = self.write(synthetic.make_recording(4.0), brief=True)
        self.assertIn('<meta name="viewport" content="width=device-width, initial-scale=1">', text)
        self.assertRegex(text, r'<div class="verdict S">\s*<p><b>S</b> success: ')
        self.assertIn("optical axis, and within 100 mm of 0.3 m along it, for 1.0 s without a break", text)

    def test_shows_faults_what_must_hold_and_does_not_and_leads_into_the_film(self):
        data = synthetic.make_recording(3.0)
        data.fault_events = [recording.FaultEvent(int(data.ticks[100]), "drop/tf:0.3", "dropped <one>")]
        content = {**judge.judge(data).as_json(), "invariants": {"violations": ["step <beyond>"]}}
        text = report.render(content, data, [])
        self.assert_sound(text)
        self.assertLess(text.index("<td>step &lt;beyond&gt;</td>"), text.index("<h2>Timeline</h2>"))
        self.assertIn('<td>drop/tf:0.3</td><td class="number">1</td>', text)
        self.assertRegex(text, r'<a href="#film" data-at="1\.00">1\.00</a>')

    def test_every_figure_of_the_judge_has_words_and_a_unit(self):
        data = synthetic.make_recording(4.0)
        content = {"figures": judge.judge(data).figures, "invariants": invariants.check(data).figures,
                   "reaction": reaction.times(data)}
        without = [name for group in content.values() for name in group
                   if name not in measures.WORDS and name not in measures.TOLD_ELSEWHERE]
        self.assertEqual(without, [])
        self.assertIn(("images in which the tag was detected", "100", "%"), measures.rows(content))

    def test_in_a_sweep_leads_back_to_the_table(self):
        with tempfile.TemporaryDirectory() as folder:
            for place, back in (("trials/some.part", True), ("alone", False)):
                os.makedirs(os.path.join(folder, place))
                out = os.path.join(folder, place, "report.html")
                report.write_brief(out, "trial.bag", None, judge.invalid("cut").as_json())
                with open(out, encoding="utf-8") as stream:
                    self.assertEqual('href="../../index.html"' in stream.read(), back)

    def test_key_frames_are_taken_at_the_moments_that_matter(self):
        data = synthetic.make_recording(4.0)
        pair = ("box", "camera_link")
        data.contacts = [recording.Contact(int(data.ticks[row]), pair, force)
                         for row, force in ((150, 2.0), (250, 7.5), (300, 3.0))]
        self.assertEqual(pictures.moments(data, judge.judge(data).figures), [
            (0.0, "the start"), (1.0, "reached"), (2.5, "largest contact, 7.5 N"),
            (4.0, "the end")])

    def test_is_the_same_text_for_the_same_trial(self):
        data = synthetic.make_recording(1.0)
        self.assertEqual(self.write(data), self.write(data))


if __name__ == "__main__":
    unittest.main()
