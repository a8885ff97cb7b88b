"""Runs clang-tidy and the check of includes on every source of a build, and knows what is clean.

    lint.py BUILD ROOT CACHE [COMMIT]

Both read the sources in groups (groups.py). Where anything is found, those of the group that it may
be about are looked at one by one.

BUILD has compile_commands.json. A source is looked at again only if it, a header of the project
that it includes, its command, the configuration or a tool has changed: CACHE keeps an empty file
by the hash of all that for each that was clean. With COMMIT only those are looked at that have
changed since, and for a header that has, one source that includes it. Prints how far it is and what
is found, as it is found; exits with 1 if there is any.
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
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from pathlib import Path

import clang_tidy
from groups import groups_of, unit_of
from includes import Project, check

TIDY = Path(sys.executable).parent / "clang-tidy"
UNKNOWN_TO_CLANG = {"-fcx-limited-range", "-fno-gnu-unique"}  # GCC's
# GCC looks for shadows, of which a group has others; and libstdc++ calls what it calls deprecated.
NO_WARNINGS = ["-Wno-shadow", "-Wno-deprecated-declarations"]
# It includes a header of CGAL 5.5 that the clang of these tools does not compile.
UNREADABLE = {Path("tests/cpp/cgal_test.cpp")}


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


def changed_since(commit: str, root: Path) -> set[Path] | None:
    """Return the files that differ from those of a commit, None where that cannot be told."""
    changed: set[Path] = set()
    for words in (
        ["diff", "--name-only", commit, "--"],
        ["ls-files", "--others", "--exclude-standard"],
    ):
        done = subprocess.run(["git", "-C", root, *words], capture_output=True, text=True)
        if done.returncode:
            return None
        changed.update(map(Path, done.stdout.splitlines()))
    return changed


def touched_by(changed: set[Path], sources: list[Path], project: Project) -> set[Path]:
    """Return the changed sources, and for each other changed file a source that reads it."""
    touched = changed & set(sources)
    covered = {file for source in touched for file in read_with(source, project)}
    for header in sorted(changed - covered):
        readers = [source for source in sources if header in read_with(source, project)]
        touched.update(sorted(readers, key=lambda source: source.stem != header.stem)[:1])
    return touched


def within(
    commands: dict[str, list[str]], changed: set[Path] | None, project: Project
) -> dict[str, list[str]]:
    """Return those of the sources that what has changed is about; all, where that is not known."""
    if changed is None:
        print("lint: this is no clone that has the last clean commit: all sources are looked at")
        return commands
    files = {name: project.file(name) for name in commands}
    touched = touched_by(changed, [file for file in files.values() if file], project)
    return {name: words for name, words in commands.items() if files[name] in touched}


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


def tidied_and_checked(unit: str, words: list[str], resources: str, project: Project) -> list[str]:
    """Return what both have to say about a source, or about all of a group."""
    return tidy(unit, words) + check(unit, words, resources, project)


def verdicts_on(
    groups: list[list[str]], commands: dict[str, list[str]], project: Project, units: Path
) -> Iterator[tuple[list[str], list[str], list[str]]]:
    """Yield each group, as they are done, with what is found and those it may be about.

    Those of a group of several come up again, one by one. The files of such groups go into `units`.
    """
    resources = str(next(Path(clang_tidy.__file__).parent.glob("data/lib/clang/*")))
    with ProcessPoolExecutor() as pool:
        running: dict[Future[list[str]], list[str]] = {}

        def start(group: list[str]) -> None:
            words, unit = commands[group[0]], unit_of(group, units)
            running[pool.submit(tidied_and_checked, unit, words, resources, project)] = group

        for group in groups:
            start(group)
        while running:
            for verdict in wait(running, return_when=FIRST_COMPLETED).done:
                group, found = running.pop(verdict), verdict.result()
                unclear = suspects(group, found, project) if found else []
                if len(group) > 1:
                    for name in unclear:
                        start([name])
                yield group, found, unclear


def main() -> int:
    """Print what is found in the sources that are not known to be clean."""
    build, root, cache = (Path(argument).resolve() for argument in sys.argv[1:4])
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
        if source is not None and source not in UNREADABLE:
            words = arguments(entry)
            mark = cache / key_of(source, words, project, tools)
            if not mark.exists():
                commands[name], marks[name] = words, mark
    if len(sys.argv) > 4:
        commands = within(commands, changed_since(sys.argv[4], root), project)
    os.chdir(build)  # the flags are relative to it
    units = cache / "groups"
    units.mkdir(parents=True, exist_ok=True)
    complaints: set[str] = set()
    clean = 0
    for group, found, unclear in verdicts_on(groups_of(commands), commands, project, units):
        for name in group:
            if name not in unclear:
                marks[name].touch()
        clean += len(group) - len(unclear)
        if len(group) == 1:
            for complaint in found:
                if complaint not in complaints:  # of a header, which comes with several sources
                    print(complaint)
            complaints.update(found)
        print(f"lint: {clean} of {len(commands)} sources are clean", flush=True)
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
