#!/usr/bin/env python3
"""Refuses files of the library that decide by too many numbers.

    numbers.py [ROOT]

ROOT is a checkout. A file has at most 12 named numbers: scalars that are constexpr, and whose value
has a literal in it. Tables and types are none, nor is 0, or a mark below it.
What a number is worth, `./dev ablate` tells: docs/design/ablation.md.
"""
from __future__ import annotations

import pathlib
import re
import sys
from collections.abc import Iterator

from lengths import code_of

MOST = 12
DECLARATION = re.compile(r"\bconstexpr\s+(?:\w+::)*(?:[a-z]\w*|Index)\s+(k[A-Z]\w*\s*[={][^;]*);")
BRACKETS = re.compile(r"\[[^\]]*\]|\([^()]*\)|\{[^{}]*\}|<[^<>]*>")
LITERAL = re.compile(r"(?<![\w.])[\d.]*\d")
MARK = re.compile(r"0|-\d+")


def numbers(text: str) -> Iterator[str]:
    """Yield the names of the numbers of a source."""
    for declared in DECLARATION.findall(code_of(text)):
        for one in re.split(r",\s*(?=k[A-Z]\w*\s*[={])", declared):
            name, value = re.split(r"\s*(?==|\{)", one, maxsplit=1)
            value = value.strip("= {}\n")
            if not MARK.fullmatch(value) and LITERAL.search(BRACKETS.sub("", value)):
                yield name


def main() -> int:
    """Print what is refused; 1 if anything is."""
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".").resolve()
    found, all_of_them = [], 0
    for file in sorted((root / "src").rglob("*")):
        if file.suffix not in (".h", ".cpp"):
            continue
        names = list(numbers(file.read_text()))
        all_of_them += len(names)
        if len(names) > MOST:
            found.append(
                f"{file.relative_to(root).as_posix()}: {len(names)} numbers, more than {MOST}: "
                "take away those that ./dev ablate finds worth nothing"
            )
    if all_of_them == 0:
        found.append(f"{root}: no numbers here")
    print("\n".join(found) if found else f"{all_of_them} numbers, at most {MOST} in a file")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
