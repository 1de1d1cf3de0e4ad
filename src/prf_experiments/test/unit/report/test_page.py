# SPDX-License-Identifier: BSD-3-Clause
import unittest

import jinja2
from prf_experiments.report import page, plots
from prf_experiments.report.page import Markup, Section

from prf_experiments import python_packages


class Page(unittest.TestCase):
    def test_tables_show_values_as_people_read_them(self):
        text = page.table([(True, False, None, 0.123456, 7, "a & b", Markup("<b>c</b>"))],
                          ("x < y",))
        self.assertIn("<tr><th>x &lt; y</th></tr>", text)
        self.assertIn("<tr><td>yes</td><td>no</td><td>–</td><td class=\"number\">0.1235</td>"
                      "<td class=\"number\">7</td><td>a &amp; b</td><td><b>c</b></td></tr>", text)

    def test_texts_get_room_so_that_a_narrow_screen_scrolls_rather_than_stacks_their_words(self):
        text = page.table([("short", 30 * "x", 70 * "x", Markup("<b>") + "y" + Markup("</b>"))])
        self.assertIn(f'<td>short</td><td class="words">{30 * "x"}</td><td class="text">{70 * "x"}</td><td><b>y', text)

    def test_everything_is_escaped_that_is_not_markup(self):
        text = page.render("study.html", title="<t>", command="<c>", text="<x>", conclusion="<o>",
                           sections=[Section("<s>", "<p>", [Markup("<hr>")])])
        for word in ("t", "c", "x", "o", "s", "p"):
            self.assertIn(f"&lt;{word}&gt;", text)
        self.assertIn("<hr>", text)

    def test_a_page_brings_the_library_of_its_plots_once_and_only_then(self):
        named = {"title": "t", "command": "", "text": "", "conclusion": ""}
        plain = page.whole("study.html", **named, sections=[])
        self.assertNotIn("plot-library", plain)
        plot = Markup('<div data-plot="x"></div>')
        drawn = page.whole("study.html", **named, sections=[Section("s", body=[plot, plot])])
        self.assertEqual(drawn.count('id="plot-library"'), 1)
        self.assertTrue(drawn.rstrip().endswith("</body></html>"))

    def test_a_plot_without_its_library_says_what_to_install(self):
        def draw():
            raise plots.Missing("No module named 'bokeh'; " + python_packages.how_to_get("bokeh"))
        self.assertIn("./run_tests installs", page.plotted(draw))

    def test_a_legend_has_as_many_columns_as_a_phone_has_room_for(self):
        for length, columns in ((5, 3), (20, 2), (30, 1)):
            panel = plots.panel("y")
            for name in "abc":
                plots.add_line(panel, [0, 1], [0, 1], length * name)
            plots.legend_above(panel)
            self.assertEqual(panel.legend[0].ncols, columns)

    def test_a_value_that_a_template_needs_must_be_given(self):
        with self.assertRaises(jinja2.UndefinedError):
            page.render("study.html", title="t")


if __name__ == "__main__":
    unittest.main()
