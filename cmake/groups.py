"""Sources that a compiler reads together: most of its time goes into the system's headers.

    groups.py TARGETS KEPT

reads a line for each target, its name and its sources parted by tabs, and prints the groups of
several sources likewise; Unity.cmake has them compiled so. For clang lint.py puts them together.
The file KEPT has the groups of the time before, so that an edit regroups no more than what it has
brought into conflict.

What is declared in one file only, its tests and the helpers in anonymous namespaces, meets the
other files of its group and the headers of these; so no two files of a group have a name in common,
and none has a name of its own that a header of another declares. Where that does not do, the group
does not compile, and lint.py looks at its files one by one; in a build such a file is given
SKIP_UNITY_BUILD_INCLUSION.
"""

from __future__ import annotations

import re
import sys
from functools import cache
from pathlib import Path

# Sources of a group: so that every core gets some, and that none takes more memory than a gigabyte
# or so.
MOST = 12
# Lines of a group that a build compiles, headers not counted. It is what some ten seconds of a core
# optimise; an edit waits for the group that it is in.
MOST_LINES = 1500
ROOT = Path(__file__).parents[1]
FOLDERS = [ROOT / folder for folder in ("include", "src", "program", "tests", "")]

# What is declared at the beginning of a line, which is to say in no block, and is no macro's.
NAMES = re.compile(
    r"^(?:struct|class|enum class|union)\s+(\w+)"
    r"|^(?!(?:using )?namespace\b|template\b|[A-Z_]+\()"
    r"[A-Za-z][^\n(=;{\[]*?(?<!:)\b(\w+)\s*[(=;{\[]",
    re.M,
)
# What is brought in from another namespace of the project, beside which another of that name is an
# overload.
IMPORTS = re.compile(r"^using (?:\w+::)+(\w+);", re.M)
# Of the project's headers, of which only the public one stands in angle brackets.
INCLUDES = re.compile(r'^#include (?:"|<(?=beltrami/))([^">]+)', re.M)
# Of which one line may have several.
CONSTANTS = re.compile(r"^const(?:expr)? [^;{]*;", re.M)


def names_of(text: str) -> set[str]:
    """Return the names that a source declares outside of any block, and perhaps a few more."""
    names = {first or second for first, second in NAMES.findall(text)}
    for line in CONSTANTS.findall(text):
        names.update(re.findall(r"\b(\w+) =", line))
    return names


@cache
def included_by(path: Path) -> list[Path]:
    """Return the headers of the project that a file itself includes."""
    found = []
    for name in INCLUDES.findall(path.read_text()):
        for folder in (path.parent, *FOLDERS):
            if (header := folder / name).is_file():
                found.append(header)
                break
    return found


def headers_of(path: Path) -> set[Path]:
    """Return the headers of the project that a file includes, and those that they include."""
    seen, todo = set(), [path]
    while todo:
        for header in included_by(todo.pop()):
            if header not in seen:
                seen.add(header)
                todo.append(header)
    return seen


@cache
def declared_by(header: Path) -> set[str]:
    """Return the names that a header declares."""
    return names_of(header.read_text())


class Group:
    """Sources that may be read together, and the names by which others must not join them."""

    def __init__(self) -> None:
        self.members: list[str] = []
        self.lines = 0
        self._kind: object = None
        self._taken: set[str] = set()
        self._meant: set[str] = set()
        self._repeated: set[str] = set()
        self._brought: set[str] = set()

    def takes(self, source: Source) -> bool:
        """Return whether a source may join."""
        return (
            (not self.members or source.kind == self._kind)
            and len(self.members) < MOST
            and not (self._taken & (source.own | source.shared) or self._meant & source.own)
            and not (self._brought & source.again or source.imported & self._repeated)
        )

    def add(self, source: Source) -> None:
        """Have a source join."""
        self._kind = source.kind
        self._taken |= source.own
        self._meant |= source.shared
        self._repeated |= source.again
        self._brought |= source.imported
        self.lines += source.lines
        self.members.append(source.name)


class Source:
    """A source, and the names that it declares or may mean."""

    def __init__(self, name: str, words: list[str]) -> None:
        path = Path(name)
        self.name = name
        # The language of C has no namespaces, and no groups.
        self.kind = (words, path if path.suffix == ".c" else None)
        self.room = path.parent
        self.shared: set[str] = set()  # what headers declare, it may mean
        for header in headers_of(path):
            self.shared |= declared_by(header)
        text = path.read_text()
        self.lines = text.count("\n")
        self.own, self.again = names_of(text) - self.shared, names_of(text) & self.shared
        self.imported = set(IMPORTS.findall(text)) - names_of(text)


def groups_of(sources: dict[str, list[str]]) -> list[list[str]]:
    """Part sources, given with their compiler's arguments, into groups that may be read together.

    Files of a group have the same arguments.
    """
    groups: list[Group] = []
    for name, words in sources.items():
        source = Source(name, words)
        group = next((group for group in groups if group.takes(source)), None)
        if group is None:
            groups.append(group := Group())
        group.add(source)
    return [group.members for group in groups]


def groups_to_compile(names: list[str], kept: list[list[str]]) -> list[list[str]]:
    """Part the sources of a target into groups: those of a room together, as far as may be.

    `kept` are the groups of the time before. Their sources stay together where they still may.
    """
    sources = {name: Source(name, []) for name in names}
    left = dict(sources)
    groups: list[Group] = []
    for members in kept:
        group = Group()
        for name in members:
            if name in left and group.takes(left[name]):
                group.add(left.pop(name))
        if group.members:
            groups.append(group)

    def join(source: Source, candidates: list[Group]) -> None:
        for group in candidates:
            if group.lines + source.lines <= MOST_LINES and group.takes(source):
                group.add(source)
                return
        groups.append(group := Group())
        group.add(source)

    for source in left.values():
        join(source, [g for g in groups if sources[g.members[0]].room == source.room])
    for group in [g for g in groups if len(g.members) == 1 and g.members[0] in left]:
        groups.remove(group)
        join(sources[group.members[0]], groups)
    return [group.members for group in groups]


def unit_of(group: list[str], folder: Path) -> str:
    """Return a source that is all of a group: a file in `folder` where they are several."""
    if len(group) == 1:
        return group[0]
    unit = folder / f"{Path(group[0]).stem}_and_{len(group) - 1}_more.cpp"
    unit.write_text("".join(f'#include "{name}"\n' for name in group))
    return str(unit)


def main() -> None:
    """Print the groups of several, and keep them all."""
    listed, keeper = map(Path, sys.argv[1:])
    targets = [line.split("\t") for line in listed.read_text().splitlines()]
    rows = [line.split("\t") for line in keeper.read_text().splitlines()] if keeper.exists() else []
    kept = ""
    for target, *sources in targets:
        before = [group for owner, *group in rows if owner == target]
        for group in groups_to_compile(sources, before):
            kept += "\t".join([target, *group]) + "\n"
            if len(group) > 1:
                print(target, *group, sep="\t")
    keeper.write_text(kept)


if __name__ == "__main__":
    main()
