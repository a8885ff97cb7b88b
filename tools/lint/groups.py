"""Sources that one run of clang reads together: most of its time goes into the system's headers.

What is declared in one file only, its tests and the helpers in anonymous namespaces, meets the
other files of its group; so no two files of a group have a name in common. Where that does not do,
the group does not compile, and lint.py looks at its files one by one.
"""

from __future__ import annotations

import re
from pathlib import Path

# So that every core gets some, and that none takes more memory than a gigabyte or so.
MOST = 12

# What is declared at the beginning of a line, which is to say in no block, and is no macro's.
NAMES = re.compile(
    r"^(?:struct|class|enum class|union)\s+(\w+)"
    r"|^(?!namespace\b|template\b|[A-Z_]+\()[A-Za-z][^\n(=;{\[]*?(?<!:)\b(\w+)\s*[(=;{\[]",
    re.M,
)


def names_of(text: str) -> set[str]:
    """Return the names that a source declares outside of any block, and perhaps a few more."""
    return {first or second for first, second in NAMES.findall(text)}


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
