"""Runs clang-tidy and the check of includes on every source of a build, and knows what is clean.

    lint.py BUILD ROOT CACHE

Both read the sources in groups (groups.py). Where anything is found, those of the group that it may
be about are looked at one by one.

BUILD has compile_commands.json. A source is looked at again only if it, a header of the project
that it includes, its command, the configuration or a tool has changed: CACHE keeps an empty file
by the hash of all that for each that was clean. Prints what is found; exits with 1 if there is any.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import shlex
import subprocess
import sys
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import clang_tidy
from groups import groups_of, unit_of
from includes import Project, check

TIDY = Path(sys.executable).parent / "clang-tidy"
UNKNOWN_TO_CLANG = {"-fcx-limited-range", "-fno-gnu-unique"}  # GCC's
# GCC looks for shadows, of which a group has others; and libstdc++ calls what it calls deprecated.
NO_WARNINGS = ["-Wno-shadow", "-Wno-deprecated-declarations"]


def arguments(entry: dict) -> list[str]:
    """Return the flags of a compile command, without the compiler, the source and the object."""
    words = shlex.split(entry["command"])[1:]
    if not Path(words[0]).suffix and not words[0].startswith("-"):  # after a launcher
        words = words[1:]
    known = [word for word in words[: words.index("-o")] if word not in UNKNOWN_TO_CLANG]
    return known + NO_WARNINGS


def read_with(source: Path, project: Project) -> set[Path]:
    """Return the files of the project that are read with a source, itself among them."""
    seen, todo = set(), [source]
    while todo:
        path = todo.pop()
        if path not in seen:
            seen.add(path)
            todo += project.includes(path)
    return seen


def key_of(source: Path, words: list[str], project: Project, tools: str) -> str:
    """Return the hash of all that the verdict on a source depends on."""
    digest = hashlib.sha256(f"{tools}{words}".encode())
    for path in sorted(read_with(source, project)):
        digest.update(f"{path}\n".encode() + (project.root / path).read_bytes())
    return digest.hexdigest()


def tidy(name: str, words: list[str]) -> list[str]:
    """Return clang-tidy's complaints, without its counts of what it does not show."""
    done = subprocess.run([TIDY, "--quiet", name, "--", *words], capture_output=True, text=True)
    return [done.stdout + done.stderr] if done.returncode else []


def suspects(group: list[str], found: list[str], project: Project) -> list[str]:
    """Return the sources of a group that complaints may be about, all where it does not compile."""
    text = "\n".join(found)
    named = {project.root / name for name in re.findall(r"^([^\s:]+):\d+:", text, re.M)}
    if not named or "clang-diagnostic-error" in text:
        return group
    return [
        name
        for name in group
        if any(project.root / path in named for path in read_with(project.file(name), project))
    ]


def verdicts_on(
    groups: list[list[str]], commands: dict[str, list[str]], project: Project, units: Path
) -> Iterator[tuple[list[str], list[str]]]:
    """Yield each group with what is found in it; the files of the larger ones go into `units`."""
    resources = next(Path(clang_tidy.__file__).parent.glob("data/lib/clang/*"))
    with ProcessPoolExecutor() as pool:
        verdicts = []
        for group in groups:
            unit, words = unit_of(group, units), commands[group[0]]
            verdicts.append(
                (
                    pool.submit(tidy, unit, words),
                    pool.submit(check, unit, words, str(resources), project),
                )
            )
        for group, (tidied, checked) in zip(groups, verdicts, strict=True):
            yield group, tidied.result() + checked.result()


def main() -> int:
    """Print what is found in the sources that are not known to be clean."""
    build, root, cache = (Path(argument).resolve() for argument in sys.argv[1:])
    configuration = [root / ".clang-tidy", *root.glob("*/.clang-tidy")]
    here = Path(__file__).parent
    tools = "".join(
        path.read_text()
        for path in [*configuration, *here.glob("*.py"), here.parent / "requirements.txt"]
    )
    project = Project(root)
    entries = json.loads((build / "compile_commands.json").read_text())
    commands, marks = {}, {}
    for name, entry in sorted({entry["file"]: entry for entry in entries}.items()):
        source = project.file(name)
        if source is not None:
            words = arguments(entry)
            mark = cache / key_of(source, words, project, tools)
            if not mark.exists():
                commands[name], marks[name] = words, mark
    os.chdir(build)  # the flags are relative to it
    units = cache / "groups"
    units.mkdir(parents=True, exist_ok=True)
    todo = groups_of(commands)
    complaints: dict[str, None] = {}
    while todo:
        again = []
        for group, found in verdicts_on(todo, commands, project, units):
            unclear = suspects(group, found, project) if found else []
            for name in group:
                if name not in unclear:
                    marks[name].touch()
            if len(group) > 1:
                again += [[name] for name in unclear]
            else:
                complaints |= dict.fromkeys(found)
        todo = again
    for complaint in complaints:
        print(complaint)
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
