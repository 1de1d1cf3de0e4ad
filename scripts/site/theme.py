# SPDX-License-Identifier: BSD-3-Clause
"""Debian's theme `furo` needs a web server with Debian's aliases; a site in a folder must do without."""
import pathlib
import re

SHARED = pathlib.Path("/usr/share/javascript")


def _put_in(file, imported, folder):
    text = file.read_text(encoding="utf-8")
    file.write_text(re.sub(imported, lambda found: (folder / found[1]).read_text(encoding="utf-8"), text,
                           flags=re.MULTILINE), encoding="utf-8")


def stand_alone(static):
    """Puts what the theme's script and style sheet import in place of the imports.

    A script with `import` is none to a browser that was not told so, and gets no file beside it from a folder;
    then neither the table of contents follows the page nor can light and dark be chosen.
    """
    script, style = static / "scripts" / "furo.js", static / "styles" / "furo.css"
    _put_in(script, r'^import Gumshoe from "(.+)";$', script.parent)
    _put_in(style, r"@import url\(/javascript/([\w./-]+)\);", SHARED)
