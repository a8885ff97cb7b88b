"""Runs clang-tidy and the check of includes on every source of a build, and knows what is clean.

    lint.py BUILD ROOT CACHE

BUILD has compile_commands.json. A source is looked at again only if it, a header of the project
that it includes, its command, the configuration or a tool has changed: CACHE keeps an empty file
by the hash of all that for each that was clean. Prints what is found; exits with 1 if there is any.
"""

from __future__ import annotations

import hashlib
import json
import os
import shlex
import subprocess
import sys
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

from includes import Project, check

UNKNOWN_TO_CLANG = {"-fcx-limited-range", "-fno-gnu-unique"}  # GCC's


def output_of(*command: str) -> str:
    """Return what a command prints."""
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


def arguments(entry: dict) -> list[str]:
    """Return the flags of a compile command, without the compiler, the source and the object."""
    words = shlex.split(entry["command"])[1:]
    if not Path(words[0]).suffix and not words[0].startswith("-"):  # after a launcher
        words = words[1:]
    return [word for word in words[: words.index("-o")] if word not in UNKNOWN_TO_CLANG]


def key_of(source: Path, words: list[str], project: Project, tools: str) -> str:
    """Return the hash of all that the verdict on a source depends on."""
    seen, todo = set(), [source]
    while todo:
        path = todo.pop()
        if path not in seen:
            seen.add(path)
            todo += project.includes(path)
    digest = hashlib.sha256(f"{tools}{words}".encode())
    for path in sorted(seen):
        digest.update(f"{path}\n".encode() + (project.root / path).read_bytes())
    return digest.hexdigest()


def tidy(name: str, words: list[str]) -> list[str]:
    """Return clang-tidy's complaints, without its counts of what it does not show."""
    done = subprocess.run(
        ["clang-tidy", "--quiet", name, "--", *words], capture_output=True, text=True
    )
    return [done.stdout + done.stderr] if done.returncode else []


def main() -> int:
    """Print what is found in the sources that are not known to be clean."""
    build, root, cache = (Path(argument).resolve() for argument in sys.argv[1:])
    resources = output_of("clang", "-print-resource-dir").strip()
    configuration = [root / ".clang-tidy", *root.glob("*/.clang-tidy")]
    here = Path(__file__).parent
    tools = output_of("clang-tidy", "--version") + "".join(
        path.read_text() for path in [*configuration, *here.glob("*.py")]
    )
    project = Project(root)
    entries = {
        entry["file"]: entry for entry in json.loads((build / "compile_commands.json").read_text())
    }
    pending = {}
    for name, entry in sorted(entries.items()):
        source = project.file(name)
        if source is not None:
            words = arguments(entry)
            pending[name] = (words, cache / key_of(source, words, project, tools))
    pending = {name: (words, mark) for name, (words, mark) in pending.items() if not mark.exists()}
    os.chdir(build)  # the flags are relative to it
    cache.mkdir(parents=True, exist_ok=True)
    complaints: dict[str, None] = {}
    with ProcessPoolExecutor() as pool:
        verdicts = {}
        for name, (words, _) in pending.items():
            verdicts[name] = (
                pool.submit(tidy, name, words),
                pool.submit(check, name, words, resources, project),
            )
        for name, (_, mark) in pending.items():
            found = [line for verdict in verdicts[name] for line in verdict.result()]
            complaints |= dict.fromkeys(found)
            if not found:
                mark.touch()
    for complaint in complaints:
        print(complaint)
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
