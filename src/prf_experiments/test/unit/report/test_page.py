# SPDX-License-Identifier: BSD-3-Clause
import unittest

import jinja2
from prf_experiments.report import page
from prf_experiments.report.page import Markup, Section


class Page(unittest.TestCase):
    def test_tables_show_values_as_people_read_them(self):
        text = page.table([(True, False, None, 0.123456, 7, "a & b", Markup("<b>c</b>"))],
                          ("x < y",))
        self.assertIn("<tr><th>x &lt; y</th></tr>", text)
        self.assertIn("<tr><td>yes</td><td>no</td><td>–</td><td class=\"number\">0.1235</td>"
                      "<td class=\"number\">7</td><td>a &amp; b</td><td><b>c</b></td></tr>", text)

    def test_everything_is_escaped_that_is_not_markup(self):
        text = page.render("study.html", title="<t>", command="<c>", text="<x>", sections=[
            Section("<s>", "<p>", [Markup("<hr>")])])
        for word in ("t", "c", "x", "s", "p"):
            self.assertIn(f"&lt;{word}&gt;", text)
        self.assertIn("<hr>", text)

    def test_a_value_that_a_template_needs_must_be_given(self):
        with self.assertRaises(jinja2.UndefinedError):
            page.render("study.html", title="t")


if __name__ == "__main__":
    unittest.main()
