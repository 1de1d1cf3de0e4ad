# SPDX-License-Identifier: BSD-3-Clause
"""Equations as MathML, which browsers draw themselves: no script, nothing from the network."""
from docutils import nodes
from docutils.utils.math import latex2mathml


def _draw(visitor, node, block):
    tex = node.astext()
    begin = r"\begin{"
    if block and r"\\" in tex and begin not in tex:
        tex = r"\begin{aligned}" + tex + r"\end{aligned}"
    visitor.body.append(latex2mathml.tex2mathml(tex, inline=not block))
    raise nodes.SkipNode


def setup(app):
    app.add_html_math_renderer("mathml", (lambda visitor, node: _draw(visitor, node, False), None),
                               (lambda visitor, node: _draw(visitor, node, True), None))
    return {"parallel_read_safe": True}
