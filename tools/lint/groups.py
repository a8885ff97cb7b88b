"""Sources that a compiler reads together: most of its time goes into the system's headers.

    groups.py SOURCE...

prints groups of several with a line for each, parted by tabs; a build with BELTRAMI_UNITY compiles
them so. For clang they are put together by lint.py.

What is declared in one file only, its tests and the helpers in anonymous namespaces, meets the
other files of its group; so no two files of a group have a name in common. Where that does not do,
the group does not compile, and lint.py looks at its files one by one; in a build such a file is
given SKIP_UNITY_BUILD_INCLUSION.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

# So that every core gets some, and that none takes more memory than a gigabyte or so.
MOST = 12

# What is declared at the beginning of a line, which is to say in no block, and is no macro's.
NAMES = re.compile(
    r"^(?:struct|class|enum class|union)\s+(\w+)"
    r"|^(?!(?:using )?namespace\b|template\b|[A-Z_]+\()"
    r"[A-Za-z][^\n(=;{\[]*?(?<!:)\b(\w+)\s*[(=;{\[]",
    re.M,
)
# Of which one line may have several.
CONSTANTS = re.compile(r"^const(?:expr)? [^;{]*;", re.M)


def names_of(text: str) -> set[str]:
    """Return the names that a source declares outside of any block, and perhaps a few more."""
    names = {first or second for first, second in NAMES.findall(text)}
    for line in CONSTANTS.findall(text):
        names.update(re.findall(r"\b(\w+) =", line))
    return names


def groups_of(sources: dict[str, list[str]]) -> list[list[str]]:
    """Part sources, given with their compiler's arguments, into groups that may be read together.

    Files of a group have the same arguments; the language of C has no namespaces, and no groups.
    """
    groups: list[tuple[object, set[str], list[str]]] = []
    for name, words in sources.items():
        path = Path(name)
        kind = (words, path if path.suffix == ".c" else None)
        names = names_of(path.read_text())
        for other, taken, members in groups:
            if other == kind and len(members) < MOST and not taken & names:
                break
        else:
            taken, members = set(), []
            groups.append((kind, taken, members))
        taken |= names
        members.append(name)
    return [members for _, _, members in groups]


def unit_of(group: list[str], folder: Path) -> str:
    """Return a source that is all of a group: a file in `folder` where they are several."""
    if len(group) == 1:
        return group[0]
    unit = folder / f"{Path(group[0]).stem}_and_{len(group) - 1}_more.cpp"
    unit.write_text("".join(f'#include "{name}"\n' for name in group))
    return str(unit)


if __name__ == "__main__":
    for group in groups_of({name: [] for name in sys.argv[1:]}):
        if len(group) > 1:
            print(*group, sep="\t")
