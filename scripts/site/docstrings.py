# SPDX-License-Identifier: BSD-3-Clause
"""Our docstrings are plain text: what is indented stands as it is, bullets are a list."""
import inspect


def plain(lines):
    """The docstring as reStructuredText: indented parts become literal blocks."""
    out, literal, bullet = [], False, False
    for line in lines:
        line = line.replace("*", "\\*").replace("|", "\\|").replace("`_", "` _")
        indented = line.startswith("  ")
        if line.strip() and not indented:
            if literal:
                out.append("")
            if line.startswith("- ") and not bullet and out and out[-1].strip():
                out.append("")
            if bullet and not line.startswith("- ") and out[-1].strip():
                out.append("")
            literal, bullet = False, line.startswith("- ")
        elif indented and not literal and not bullet:
            out += ["", "::", ""]
            literal = True
        out.append(line)
    return out


def setup(app):
    done = set()

    def once(app, kind, name, item, skip, options):
        if item.id not in done:
            done.add(item.id)
            item.docstring = "\n".join(plain(inspect.cleandoc(item.docstring).splitlines())) + "\n\n"
        return None  # skips nothing
    app.connect("autoapi-skip-member", once)
    return {"parallel_read_safe": True}
