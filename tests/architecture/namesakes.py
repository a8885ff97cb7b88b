#!/usr/bin/env python3
"""Refuses two types of one name.

    namesakes.py [ROOT]

ROOT is a checkout. Two types of one name in one namespace have one destructor in a program: where a
compiler does not inline it, the linker keeps that of either. In unnamed namespaces names are free.
"""
from __future__ import annotations

import pathlib
import re
import sys

TREES = ["src", "program"]
SUFFIXES = {".h", ".cpp"}
OPENS = re.compile(r"(?:inline )?namespace\b ?([\w:]*) ?\{")
CLOSES = re.compile(r"\}  // namespace\b")
TYPE = re.compile(r"(?:struct|class|union|enum class|enum) (\w+)(?: final)?(?: :(?!:).*)? \{")


def types(text: str) -> dict[str, int]:
    """Return the types that are defined in namespaces with names, with the line of each."""
    found: dict[str, int] = {}
    scopes: list[str] = []
    for number, line in enumerate(text.splitlines(), 1):
        if opened := OPENS.match(line):
            scopes.append(opened[1])
        elif CLOSES.match(line):
            scopes.pop()
        elif (defined := TYPE.match(line)) and "" not in scopes:
            found["::".join([*scopes, defined[1]])] = number
    return found


def main() -> int:
    """Print each type that has a namesake, and exit with 1 if there is one."""
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".").resolve()
    first: dict[str, str] = {}
    wrong = False
    for tree in TREES:
        for path in sorted((root / tree).rglob("*")):
            if path.suffix not in SUFFIXES:
                continue
            for name, line in types(path.read_text()).items():
                place = f"{path.relative_to(root)}:{line}"
                if name in first:
                    print(f"{place}: {name} is the name of another type, at {first[name]}")
                    wrong = True
                first.setdefault(name, place)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
