# SPDX-License-Identifier: BSD-3-Clause
"""Lays out the site's sources: the repository's documents where they are, with links that a site can follow."""
import os
import pathlib
import re
import shutil

import notebooks

REPO = pathlib.Path(__file__).resolve().parents[2]
LINK = re.compile(r"(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)\s#]*)(#[^)\s]*)?\)")
MERMAID = re.compile(r"```mermaid\n.*?```\n", re.DOTALL)
PICTURES = (".svg", ".png", ".jpg")


def documents():
    """Every document of the repository that is a page of the site."""
    found = [REPO / name for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md")]
    found += [path for path in sorted((REPO / "docs").rglob("*.md")) if path.parent.name != "site"]
    return found + sorted([*REPO.glob("src/*/README.md"), *REPO.glob("src/*/python/README.md")])


def anchor(heading):
    """The anchor that a heading gets, on the site and on the usual hosts of repositories."""
    plain = re.sub(r"\[([^\]]*)\]\([^)]*\)|[`*]", r"\1", heading.strip().lower())
    return re.sub(r"[^\w\- ]", "", plain).replace(" ", "-")


def anchors(text):
    text = re.sub(r"^```.*?^```", "", text, flags=re.DOTALL | re.MULTILINE)
    return {anchor(heading) for heading in re.findall(r"^#+ +(.+)$", text, re.MULTILINE)}


def _parameters(target):
    """The page's section of a parameter file, or None."""
    parts = target.relative_to(REPO).parts
    if len(parts) >= 4 and parts[0] == "src" and parts[2] == "config" and target.suffix == ".yaml":
        return f"reference/parameters.md#{target.stem}"
    return None


def _link(page, pages):
    def renewed(found):
        picture, shown, target, section = found[1], found[2], found[3], found[4] or ""
        if not target or "://" in target or target.startswith("mailto:"):
            return found[0]
        path = pathlib.Path(os.path.normpath(page.parent / target))
        if picture or path in pages:
            return found[0]
        if path.suffix == ".ipynb":
            return f"[{shown}]({target[:-len('.ipynb')]}.md{section})"
        if path / "README.md" in pages:
            return f"[{shown}]({target.rstrip('/')}/README.md{section})"
        if parameters := _parameters(path):
            up = os.path.relpath(REPO, page.parent)
            return f"[{shown}]({os.path.normpath(os.path.join(up, parameters))})"
        return shown if shown.startswith("`") else f"`{shown}`"
    return renewed


def _header(page):
    """Names of public headers become links to their place in the C++ API."""
    up = os.path.relpath(REPO, page.parent)

    def linked(found):
        return f"[`{found[1]}/{found[2]}`]({up}/reference/cpp/{found[1]}.md#{anchor(found[2])})"
    return lambda text: re.sub(r"(?<!\[)`src/(\w+)/include/\1/([\w/]+\.hpp)`", linked, text)


def outside_code(text, change):
    """The text with `change` applied to what is not a block of code."""
    parts = re.split(r"(^```.*?^```$)", text, flags=re.DOTALL | re.MULTILINE)
    return "".join(part if part.startswith("```") else change(part) for part in parts)


def lay_out(target):
    """Writes pages and pictures below the folder `target`."""
    pages = set(documents())
    for page in pages:
        out = target / page.relative_to(REPO)
        out.parent.mkdir(parents=True, exist_ok=True)
        up = os.path.relpath(REPO / "docs" / "architecture.svg", page.parent)
        text = MERMAID.sub(f"![nodes and topics]({up})\n", page.read_text(encoding="utf-8"))
        headers, links = _header(page), _link(page, pages)
        out.write_text(outside_code(text, lambda part, links=links, headers=headers: headers(LINK.sub(links, part))),
                       encoding="utf-8")
    for picture in (path for path in (REPO / "docs").rglob("*") if path.suffix in PICTURES):
        out = target / picture.relative_to(REPO)
        out.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(picture, out)
    for notebook in (REPO / "docs").rglob("*.ipynb"):
        notebooks.write(notebook, target / notebook.parent.relative_to(REPO))
    shutil.copyfile(REPO / "docs" / "site" / "index.md", target / "index.md")
    for name in ("conf.py", "mathml.py", "docstrings.py"):
        shutil.copyfile(REPO / "scripts" / "site" / name, target / name)
    (target / "_static").mkdir(exist_ok=True)
    shutil.copyfile(REPO / "scripts" / "site" / "site.css", target / "_static" / "site.css")
