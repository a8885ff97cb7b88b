"""Sources that a compiler reads together: most of its time goes into the system's headers.

    groups.py SOURCE...

prints groups of several with a line for each, parted by tabs; a build with BELTRAMI_UNITY compiles
them so. For clang they are put together by lint.py.

What is declared in one file only, its tests and the helpers in anonymous namespaces, meets the
other files of its group and the headers of these; so no two files of a group have a name in common,
and none has a name of its own that a header of another declares. Where that does not do, the group
does not compile, and lint.py looks at its files one by one; in a build such a file is given
SKIP_UNITY_BUILD_INCLUSION.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

# So that every core gets some, and that none takes more memory than a gigabyte or so.
MOST = 12
ROOT = Path(__file__).parents[2]
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
# Of which one line may have several.
CONSTANTS = re.compile(r"^const(?:expr)? [^;{]*;", re.M)


def names_of(text: str) -> set[str]:
    """Return the names that a source declares outside of any block, and perhaps a few more."""
    names = {first or second for first, second in NAMES.findall(text)}
    for line in CONSTANTS.findall(text):
        names.update(re.findall(r"\b(\w+) =", line))
    return names


def headers_of(path: Path) -> set[Path]:
    """Return the headers of the project that a file includes, and those that they include."""
    seen, todo = set(), [path]
    while todo:
        file = todo.pop()
        for name in re.findall(r'^#include ["<]([^">]+)', file.read_text(), re.M):
            for folder in (file.parent, *FOLDERS):
                if (header := folder / name).is_file():
                    if header not in seen:
                        seen.add(header)
                        todo.append(header)
                    break
    return seen


def groups_of(sources: dict[str, list[str]]) -> list[list[str]]:
    """Part sources, given with their compiler's arguments, into groups that may be read together.

    Files of a group have the same arguments; the language of C has no namespaces, and no groups.
    """
    groups: list[tuple[object, set[str], set[str], set[str], set[str], list[str]]] = []
    declared: dict[Path, set[str]] = {}
    for name, words in sources.items():
        path = Path(name)
        kind = (words, path if path.suffix == ".c" else None)
        shared: set[str] = set()  # what headers declare, it may mean
        for header in headers_of(path):
            if header not in declared:
                declared[header] = names_of(header.read_text())
            shared |= declared[header]
        text = path.read_text()
        own, again = names_of(text) - shared, names_of(text) & shared
        imported = set(IMPORTS.findall(text)) - names_of(text)
        for other, taken, meant, repeated, brought, members in groups:
            if (
                other == kind
                and len(members) < MOST
                and not (taken & (own | shared) or meant & own)
                and not (brought & again or imported & repeated)
            ):
                break
        else:
            taken, meant, repeated, brought, members = set(), set(), set(), set(), []
            groups.append((kind, taken, meant, repeated, brought, members))
        taken |= own
        meant |= shared
        repeated |= again
        brought |= imported
        members.append(name)
    return [members for *_, members in groups]


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
