# SPDX-License-Identifier: BSD-3-Clause
"""Debian's theme `furo` needs a web server with Debian's aliases; a site in a folder must do without."""
import pathlib
import re

SHARED = pathlib.Path("/usr/share/javascript")


def _change(file, changed, into):
    text = file.read_text(encoding="utf-8")
    if (new := re.sub(changed, into, text, flags=re.MULTILINE)) != text:
        file.write_text(new, encoding="utf-8")


def stand_alone(html):
    """Puts what the theme's script and style sheet import in place of the imports.

    A browser runs a script with `import` only as a module, and loads no module from a folder; then neither does the
    table of contents follow the page nor can light and dark be chosen.
    """
    static = html / "_static"
    _change(static / "scripts" / "furo.js", r'^import (?:\* as )?Gumshoe from "(.+)";$',
            lambda found: (static / "scripts" / found[1]).read_text(encoding="utf-8"))
    _change(static / "styles" / "furo.css", r"@import url\(/javascript/([\w./-]+)\);",
            lambda found: (SHARED / found[1]).read_text(encoding="utf-8"))
    for page in html.rglob("*.html"):
        _change(page, r"<script[^>]*furo\.js[^>]*>", lambda found: found[0].replace(' type="module"', ""))
