# SPDX-License-Identifier: BSD-3-Clause
"""Pages of reference made from interfaces.yaml, the parameter files, the messages and the commands themselves."""
import os
import re
import subprocess
import sys

from layout import REPO, documents

sys.path.insert(0, str(REPO / "src" / "prf_msgs" / "python"))
from prf_msgs import interfaces

COMMAND_SECONDS = 20  # a node that takes no --help does not end by itself


def cell(text):
    """Text for a cell of a table: one line; what looks like a tag is none, unless it is code."""
    parts = re.split(r"(`[^`]*`)", " ".join(str(text).split()).replace("|", "\\|"))
    return "".join(part if part.startswith("`") else part.replace("<", "&lt;") for part in parts)


def table(titles, rows):
    lines = ["| " + " | ".join(titles) + " |", "|" + "---|" * len(titles)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def config_files():
    return sorted(path for path in REPO.glob("src/*/config/**/*.yaml"))


def nodes(interface):
    lines = ["# Nodes", "", "In the order of the data. Topics are on [their page](topics.md), parameters on "
             "[theirs](parameters.md).", ""]
    for node in interface.nodes:
        reads = [topic.name for topic in interface.topics if node.name in topic.readers]
        sends = [topic.name for topic in interface.topics if node.name in topic.senders]
        files = [path.stem for path in config_files() if path.relative_to(REPO).parts[1] == node.package
                 and path.stem in (node.name, node.package)]
        package = f"[{node.package}](../src/{node.package}/README.md)"
        lines += [f"## {node.name}", "", f"*{node.step}*, package {package}", ""]
        for title, names in (("reads", reads), ("sends", sends)):
            if names:
                lines.append(f"- {title}: " + ", ".join(f"`{name}`" for name in names))
        actions = [f"`{action['name']}`" for action in interface.actions if action["server"] == node.name]
        lines += [f"- action: {', '.join(actions)}"] if actions else []
        lines += [f"- parameters: [{stem}](parameters.md#{stem})" for stem in files] + [""]
    return "\n".join(lines)


def topics(interface):
    lines = ["# Topics", "",
             "From `src/prf_msgs/interfaces.yaml`, which the build, the recorder and the tests read.", ""]
    for title, chosen in (("Between robot and framework", ("clock", "sensor")),
                          ("Of the framework", ("output", "transform")),
                          ("Ground truth of the simulation", ("ground_truth",)),
                          ("Others", ("exempt", "description", "teaching"))):
        rows = [(f"`{topic.name}`<br>{_type(topic.type)}",
                 f"{', '.join(topic.senders)} → {', '.join([*topic.readers, *topic.also]) or '–'}",
                 cell(topic.meaning) + (f" ({cell(topic.unit)})" if topic.unit != "–" else ""))
                for topic in interface.topics if topic.kind in chosen]
        lines += [f"## {title}", "", table(("topic, type", "from → to", "meaning"), rows)]
    served = [(f"`{each['name']}`<br>{_type(each['type'])}", each["server"], cell(each["meaning"]))
              for each in [*interface.actions, *interface.services]]
    return "\n".join([*lines, "## Actions and services", "", table(("name, type", "server", "meaning"), served)])


def _type(name):
    package, kind = name.split("/")
    return f"[{name}](messages.md#{kind.lower()})" if package == "prf_msgs" else name


def _entries(path):
    """(description, [(key, value, meaning)]) of a parameter file; its comments stand above or behind the keys."""
    head: list[str] = []
    above: list[str] = []
    rows: list[list[str]] = []
    levels: list[tuple[int, str]] = []
    fresh = False  # whether `above` belongs to what follows
    for line in path.read_text(encoding="utf-8").splitlines():
        if "SPDX" in line:
            continue
        key = re.match(r"^( *)(?:- )?([\w/~]+):(?: +(.*))?$", line)
        if not line.strip():
            if not rows and above:
                head, above = head + above, []
            above = []
        elif line.lstrip().startswith("#"):
            words = line.strip().lstrip("#").strip()
            if rows and len(line) - len(line.lstrip()) > 8:  # goes on behind a key
                rows[-1][2] += " " + words
                continue
            above = [*above, words] if fresh else [words]
            fresh = True
        elif key:
            depth, value = len(key[1]), key[3] or ""
            levels = [*[(at, name) for at, name in levels if at < depth], (depth, key[2])]
            text = re.match(r"""((?:"[^"]*"|'[^']*'|[^#])*)(?:# ?(.*))?$""", value)
            assert text is not None  # it matches anything
            if text[2] and not rows:  # the comment above is about the file
                head, above = head + above, []
            meaning = text[2] or " ".join(above)
            if text[1].strip():
                rows.append([".".join(name for _, name in levels), text[1].strip(), meaning])
            fresh = False
        elif rows:  # a value that goes on
            rows[-1][1] += " " + line.split("#")[0].strip()
    return head, rows


def parameters():
    lines = ["# Parameters", "",
             "Made from the parameter files themselves. All keys are required, unknown ones are refused.", ""]
    for path in config_files():
        head, rows = _entries(path)
        lines += [f"## {path.stem}", "", f"`{path.relative_to(REPO)}`", "", cell(" ".join(head)), "",
                  table(("parameter, value", "unit, bounds, meaning"),
                        [(f"`{key}`<br>{cell(f'`{value}`')}", cell(meaning)) for key, value, meaning in rows])]
    return "\n".join(lines)


def _fields(text):
    """Rows (name and type, meaning) of a message; comments on lines of their own get a row, too."""
    rows = []
    for line in text.splitlines():
        body, _, comment = line.partition("#")
        words = body.split(None, 1)
        if len(words) == 2:
            rows.append([f"`{words[1].strip()}`<br>{words[0]}", cell(comment)])
        elif comment.strip() and body and rows:
            rows[-1][1] += " " + cell(comment)
        elif comment.strip():
            rows.append(["", f"*{cell(comment)}*"])
        elif body.strip() == "---":
            rows.append(["", "**– – –**"])
    return rows


def messages():
    lines = ["# Messages", "", "Of `prf_msgs`, made from the definitions.", ""]
    for path in sorted([*REPO.glob("src/*/msg/*.msg"), *REPO.glob("src/*/action/*.action")]):
        rows = _fields(path.read_text(encoding="utf-8"))
        while rows and not rows[0][0]:
            head = rows.pop(0)
            lines += ([f"## {path.stem}", ""] if f"## {path.stem}" not in lines else []) + [head[1].strip("*"), ""]
        lines += [] if f"## {path.stem}" in lines else [f"## {path.stem}", ""]
        lines += [table(("field, type", "meaning"), rows)]
    return "\n".join(lines)


def commands(devel):
    """What each command that a document names says on --help; `devel` is the devel space of a build, or None."""
    variables = environment(devel)
    texts = [path.read_text(encoding="utf-8") for path in documents()]
    named = sorted({found for text in texts for found in re.findall(r"rosrun (\w+) (\w+)", text)
                    if "_test_" not in found[1]})
    lines = ["# Commands", "",
             "`./run_experiment` and `./run_tests` in the root; the others with `rosrun PACKAGE COMMAND` in a sourced "
             "workspace.", "", "## run_experiment", "",
             _block(_help([sys.executable, "-m", "prf_experiments.sweep.experiment"], devel, variables))]
    for package in sorted({package for package, _ in named}):
        if not (REPO / "src" / package).is_dir():
            continue
        lines += [f"## {package}", ""]
        if (REPO / "src" / package / "README.md").exists():
            lines += [f"See also its [README](../src/{package}/README.md).", ""]
        for name in (name for of, name in named if of == package):
            told = _help([str(devel / "lib" / package / name)], devel, variables) if devel else ""
            lines += [f"### {name}", "", _block(told or f"rosrun {package} {name} --help")]
    return "\n".join(lines)


def _block(text):
    return f"```text\n{text.strip()}\n```\n"


def environment(devel):
    """Variables of a shell in which the workspace is sourced; without one, those that run_experiment needs."""
    if not devel:
        return {**os.environ, "PYTHONPATH": str(REPO / "src" / "prf_experiments" / "python")}
    told = subprocess.run(["bash", "-c", f". '{devel}/setup.bash' && env -0"], capture_output=True, text=True,
                          check=True).stdout
    return dict(line.split("=", 1) for line in told.split("\0") if "=" in line)


def _help(words, devel, variables):
    try:
        done = subprocess.run([*words, "--help"], capture_output=True, text=True, timeout=COMMAND_SECONDS, check=False,
                              env=variables, stdin=subprocess.DEVNULL)
    except (subprocess.TimeoutExpired, OSError):
        return ""
    text = done.stdout.replace(f"{devel}/lib/", "").replace(str(REPO), ".")
    return text if done.returncode == 0 else ""


def write(folder, devel):
    interface = interfaces.load()
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in (("nodes", nodes(interface)), ("topics", topics(interface)), ("parameters", parameters()),
                       ("messages", messages()), ("commands", commands(devel))):
        (folder / f"{name}.md").write_text(text, encoding="utf-8")
