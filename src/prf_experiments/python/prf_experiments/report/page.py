# SPDX-License-Identifier: BSD-3-Clause
"""HTML pages that need nothing else, and figures in them."""
import html

STYLE = """
body { font: 15px/1.5 sans-serif; color: #111; background: #fff; max-width: 66em;
       margin: 2em auto; padding: 0 1em; }
h1 { font-size: 1.5em; } h2 { font-size: 1.15em; margin-top: 2em; }
.verdict { border: 3px solid #111; padding: .6em 1em; font-size: 1.1em; }
.verdict b { font-size: 1.6em; margin-right: .5em; }
table { border-collapse: collapse; } td, th { padding: .15em 1em .15em 0; text-align: left;
        vertical-align: top; border-bottom: 1px solid #ccc; }
td.number { text-align: right; font-variant-numeric: tabular-nums; }
code, pre { background: #f2f2f2; padding: .1em .3em; }
pre { white-space: pre-wrap; padding: .6em; }
pre.wide { white-space: pre; overflow-x: auto; font-size: .85em; }
svg, img { max-width: 100%; height: auto; }
figure { display: inline-block; width: 20em; margin: 0 .6em .6em 0; }
figcaption { font-size: .85em; }
a.test { display: inline-block; min-width: 1.3em; padding: 0 .15em; margin: 1px; color: #111;
         text-align: center; text-decoration: none; border: 1px solid #111; }
a.test.P { border-style: dashed; } a.test.F { background: #111; color: #fff; }
a.test.INVALID { border-style: dotted; color: #555; } a.test:hover, a.test:focus { outline: 2px
         solid #0072B2; }
"""


class Markup(str):
    """Text that is HTML already."""


def cell(value):
    kind = (' class="number"' if isinstance(value, (int, float)) and not isinstance(value, bool)
            else "")
    text = ("yes" if value is True else "no" if value is False else "–" if value is None
            else value if isinstance(value, Markup)
            else f"{value:.4g}" if isinstance(value, float) else html.escape(str(value)))
    return f"<td{kind}>{text}</td>"


def table(rows, header=None):
    head = ("<tr>" + "".join(f"<th>{html.escape(name)}</th>" for name in header) + "</tr>"
            if header else "")
    return ("<table>" + head + "".join("<tr>" + "".join(map(cell, row)) + "</tr>" for row in rows)
            + "</table>")


def whole(title, parts):
    """The page with the title as its heading."""
    title = html.escape(title)
    return "\n".join(["<!DOCTYPE html><html lang=\"en\"><head><meta charset=\"utf-8\">",
                      f"<title>{title}</title><style>{STYLE}</style></head><body>",
                      f"<h1>{title}</h1>", *parts, "</body></html>\n"])
