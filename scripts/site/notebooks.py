# SPDX-License-Identifier: BSD-3-Clause
"""Notebooks as pages of the site: text, code and the outputs that they are kept with."""
import base64
import json


def _output(output, picture):
    """Markdown of one output; an image goes to the file `picture`."""
    data = output.get("data", {})
    if "image/png" in data:
        picture.write_bytes(base64.b64decode(data["image/png"]))
        return f"![what the cell draws]({picture.name})"
    text = "".join(output.get("text", data.get("text/plain", "")))
    return f"```text\n{text.rstrip()}\n```" if text.strip() else ""


def write(notebook, folder):
    """Writes <name>.md and its pictures into the folder."""
    with open(notebook, encoding="utf-8") as file:
        cells = json.load(file)["cells"]
    parts, pictures = [], 0
    for cell in cells:
        source = "".join(cell["source"])
        parts.append(f"```python\n{source}\n```" if cell["cell_type"] == "code" else source)
        for output in cell.get("outputs", []):
            pictures += 1
            parts.append(_output(output, folder / f"{notebook.stem}_{pictures}.png"))
    parts.insert(1, f"*To run it: `docs/notebooks/{notebook.name}`.*")
    (folder / f"{notebook.stem}.md").write_text("\n\n".join(filter(None, parts)) + "\n", encoding="utf-8")
