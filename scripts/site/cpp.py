# SPDX-License-Identifier: BSD-3-Clause
"""Pages of the C++ API, from the public headers: what the header says of itself, then its declarations."""
import re
import subprocess
import sys

from layout import REPO

# Doxygen reads comments that begin with three slashes; ours begin with two.
FILTER = f"{sys.executable} {__file__}"
SETTINGS = """
INPUT = {headers}
OUTPUT_DIRECTORY = {out}
GENERATE_HTML = NO
GENERATE_LATEX = NO
GENERATE_XML = YES
XML_PROGRAMLISTING = NO
EXTRACT_ALL = YES
QUIET = YES
WARNINGS = NO
INPUT_FILTER = "{filter}"
FULL_PATH_NAMES = YES
STRIP_FROM_PATH = {repo}/src
ENABLE_PREPROCESSING = YES
MACRO_EXPANSION = YES
EXPAND_ONLY_PREDEF = YES
PREDEFINED = EIGEN_MAKE_ALIGNED_OPERATOR_NEW=
AUTOLINK_SUPPORT = NO
MARKDOWN_SUPPORT = NO
"""


def headers():
    return sorted(REPO.glob("src/*/include/**/*.hpp"))


def split(text):
    """(lines of the comment at the header's top, the rest)."""
    lines = text.splitlines()
    end = next((at for at, line in enumerate(lines) if not line.startswith("//")), len(lines))
    return [line[2:].removeprefix(" ") for line in lines[:end] if "SPDX" not in line], lines[end:]


def filtered(text):
    """The header with comments as Doxygen wants them, without the one at its top and without its namespace.

    The page says the namespace; Breathe would make it an entry of its own for each header.
    """
    _, lines = split(text)
    out = []
    for line in lines:
        if re.match(r"\s*(inline )?namespace [\w:]+ \{$|\}\s*// namespace", line):
            line = ""
        code, mark, comment = line.partition("//")
        if mark:
            comment = re.sub(r"([\\@<>&])", r"\\\1", comment)  # what Doxygen would take for commands and tags
            comment = re.sub(r"`([^`]+)`", r"<tt>\1</tt>", comment)
            line = f"{code}///{'<' if code.strip() else ''}{comment}"
        out.append(line)
    return "\n".join(out)


def prose(lines):
    """A header's own comment as Markdown: paragraphs, and what is indented as it stands."""
    out: list[str] = []
    block: list[str] = []

    def close():
        if block:
            out.extend(["", "```text", *block, "```", ""])
            block.clear()
    for line in lines:
        if line.startswith("  "):
            block.append(line[2:])
            continue
        close()
        out.append(re.sub(r"([*_<>|\\\[\]$])", r"\\\1", line))
    close()
    return "\n".join(out).strip()


def by_package():
    packages: dict[str, list] = {}
    for path in headers():
        packages.setdefault(path.relative_to(REPO).parts[1], []).append(path)
    return packages


def run_doxygen(folder):
    """One project a package, since names may be the same in two; returns {package: folder of its XML}."""
    projects = {}
    for package, files in by_package().items():
        out = folder / package
        out.mkdir(parents=True, exist_ok=True)
        settings = SETTINGS.format(headers=" ".join(map(str, files)), out=out, filter=FILTER, repo=REPO)
        subprocess.run(["doxygen", "-"], input=settings, text=True, check=True)
        projects[package] = str(out / "xml")
    return projects


def write(folder):
    folder.mkdir(parents=True, exist_ok=True)
    packages = by_package()
    for package, files in packages.items():
        lines = [f"# {package}: C++", "",
                 f"Library `{package}`; what it is for is in [its README](../../src/{package}/README.md).", "",
                 f"```{{cpp:namespace}} {package}", "```", ""]
        for path in files:
            name = str(path.relative_to(REPO / "src" / package / "include"))
            top, _ = split(path.read_text(encoding="utf-8"))
            lines += [f"## {name.split('/', 1)[1]}", "", f"`#include \"{name}\"`", "", prose(top), "",
                      "```{doxygenfile} " + f"{package}/include/{name}",
                      f":project: {package}",
                      ":sections: briefdescription detaileddescription innerclass public-type public-func "
                      "public-static-func public-attrib public-static-attrib enum func typedef var", "```", ""]
        (folder / f"{package}.md").write_text("\n".join(lines), encoding="utf-8")
    index = ["# C++ API", "", "The public headers: the standard library and Eigen, no ROS.", "",
             "```{toctree}", ":maxdepth: 1", "", *packages, "```", ""]
    (folder / "index.md").write_text("\n".join(index), encoding="utf-8")


if __name__ == "__main__":  # as Doxygen's filter
    with open(sys.argv[1], encoding="utf-8") as header:
        print(filtered(header.read()))
