# SPDX-License-Identifier: BSD-3-Clause
"""HTML pages that need nothing else, from the templates beside this file.

Every value is escaped by the templates unless it is Markup: a figure, or what a template made.
"""
import os
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import jinja2
from markupsafe import Markup


def shown(value: Any) -> Any:
    """A value as a table shows it."""
    if value is None:
        return "–"
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:.4g}" if isinstance(value, float) else value


_TEMPLATES = jinja2.Environment(
    loader=jinja2.FileSystemLoader(os.path.join(os.path.dirname(__file__), "templates")),
    autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True, lstrip_blocks=True)
_TEMPLATES.filters["shown"] = shown


@dataclass(frozen=True)
class Section:
    """A heading, a paragraph, and what stands below them."""

    title: str
    text: str = ""
    body: Sequence[Markup] = ()


def render(template: str, **values: Any) -> Markup:
    """A template of this package with its values."""
    return Markup(_TEMPLATES.get_template(template).render(**values))


def whole(template: str, **values: Any) -> Markup:
    """A whole page, with the library that draws its plots when it has any."""
    text = render(template, **values)
    if "data-plot=" not in text:
        return text
    from prf_experiments.report import plots  # takes its time
    scripts = render("plots.html", library=plots.script())
    return Markup(str(text).replace("</body>", f"{scripts}</body>"))


def table(rows: Iterable[Iterable[Any]], header: Sequence[str] | None = None,
          kind: str = "") -> Markup:
    """A table; numbers stand at the right. `kind` is a class of the style sheet."""
    return render("table.html", rows=rows, header=header, kind=kind)


def plotted(draw: Callable[[], Markup]) -> Markup:
    """What `draw` gives, or why it cannot."""
    from prf_experiments.report import plots
    try:
        return draw()
    except plots.Missing as error:
        return Markup("<p>Not drawn: {}.</p>").format(str(error))
