#!/usr/bin/env python3
"""Runs the commands of the program that the pages show, page by page, each page in a folder of its own.

    commands.py ROOT PROGRAM

Commands are lines of ```sh blocks that begin with `beltrami`, and those of ```text blocks that begin with
`$ beltrami`. A page that shows another exit code than 0 says so behind the command: `# exit code 3`. The folder
has `examples/` of the checkout, and the meshes in it.
"""

from __future__ import annotations

import os
import pathlib
import re
import subprocess
import sys
import tempfile

BLOCK = re.compile(r"^```(sh|text)\n(.*?)^```", re.M | re.S)
EXPECTED = re.compile(r"# exit code (\d+)")
LIMIT = 300  # seconds, for what hangs


def commands(page: pathlib.Path) -> list[tuple[int, str]]:
    """Return the commands of a page, with their lines."""
    text = page.read_text()
    found = []
    for block in BLOCK.finditer(text):
        number = text.count("\n", 0, block.start(2)) + 1
        whole = ""
        for offset, line in enumerate(block[2].splitlines()):
            if whole:
                whole += "\n" + line
            elif re.match(r"\$ beltrami\b" if block[1] == "text" else r"(beltrami|printf)\b", line):
                whole = line.removeprefix("$ ")
                start = number + offset
            if whole and not whole.endswith("\\"):
                found.append((start, whole))
                whole = ""
    return found


def run(page: pathlib.Path, root: pathlib.Path, program: pathlib.Path) -> list[str]:
    """Run the commands of a page, and return a line for each that does not end as it is shown."""
    wrong = []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "bin").mkdir()
        (folder / "bin" / "beltrami").symlink_to(program)
        (folder / "examples").symlink_to(root / "examples")
        for mesh in (root / "examples" / "data").iterdir():
            (folder / mesh.name).symlink_to(mesh)
        environment = {**os.environ, "PATH": f"{folder / 'bin'}:{os.environ['PATH']}"}
        for line, command in commands(page):
            expected = int(match[1]) if (match := EXPECTED.search(command)) else 0
            done = subprocess.run(
                ["bash", "-c", command],
                cwd=folder,
                env=environment,
                capture_output=True,
                text=True,
                timeout=LIMIT,
                check=False,
            )
            if done.returncode != expected:
                wrong.append(
                    f"{page}:{line}: exit code {done.returncode}, not {expected}: {command}\n{done.stderr}"
                )
    return wrong


def main() -> int:
    """Run those of all pages."""
    root, program = (pathlib.Path(name).resolve() for name in sys.argv[1:3])
    pages = [root / "README.md", *sorted((root / "docs").rglob("*.md"))]
    count = sum(len(commands(page)) for page in pages)
    wrong = [line for page in pages for line in run(page, root, program)]
    print("\n".join([*wrong, f"{count} commands"]))
    return 1 if wrong or count == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
