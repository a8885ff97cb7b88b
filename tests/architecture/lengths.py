#!/usr/bin/env python3
"""Refuses files and functions that are too long.

    lengths.py [ROOT]

ROOT is a checkout. A file has at most 600 lines; a function of the library or of the program has at
most 70, from its first word to its last brace, but for the numeric kernels below. Lambdas count with
the function that they are in.
"""
from __future__ import annotations

import pathlib
import re
import sys
from collections.abc import Iterator

FILE_LINES = 600
# One header is the whole of the interface, most of it comments.
LONGER = {"include/beltrami/beltrami.h": 1450}
FUNCTION_LINES = 70
TREES = ["src", "program", "include", "tests", "benchmarks", "bindings", "evaluation"]
FUNCTION_TREES = ["src", "program", "include"]
SUFFIXES = {".h", ".hpp", ".c", ".cpp", ".py", ".rs"}
# Written by programs.
GENERATED = {
    "bindings/rust/beltrami-sys/src/bindings.rs",
    "bindings/rust/beltrami/src/options/table.rs",
}
# What is built, not written, may lie beside the sources.
BUILT = {"build", "target", "dist", "vendor"}

# Numeric kernels that a reader wants in one piece: file and function, and why.
KERNELS: dict[tuple[str, str], str] = {}

NOT_CODE = re.compile(
    r"""//[^\n]*|/\*.*?\*/"""
    r"""|R"(?P<tag>[^(\s]*)\(.*?\)(?P=tag)"|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])'"""
    r"""|^[ \t]*\#(?:\\\n|[^\n])*""",
    re.DOTALL | re.MULTILINE,
)
SCOPE = re.compile(r"^(?:[^()]*\b)?(?:namespace|class|struct|union|enum|extern)\b[^()]*$")
BEFORE_HEAD = re.compile(r"\s*(?:(?:public|private|protected)\s*:\s*)*")
NAME = re.compile(r"(operator\s*\S+?|[~\w:]+)\s*\(")


def code_of(text: str) -> str:
    """Return the text with comments, strings and directives blanked out."""
    return NOT_CODE.sub(lambda found: re.sub(r"[^\n]", " ", found[0]), text)


def functions(text: str) -> Iterator[tuple[str, int, int]]:
    """Yield name, first and last line of every function of C++ that is laid out by clang-format."""
    code = code_of(text)
    scopes: list[str] = []  # what each open brace belongs to: a scope, a function, an initialiser
    head = 0  # where the declaration at hand begins
    parentheses = 0
    begun = (0, "")
    for at, letter in enumerate(code):
        inside = "function" in scopes
        if letter in "()":
            parentheses += 1 if letter == "(" else -1
        elif letter == "{":
            words = code[head:at]
            kind = "scope"
            if inside or parentheses or code[at - 1].isalnum() or code[at - 1] in "_>":
                kind = "initialiser"
            elif words.rstrip().endswith("="):
                kind = "initialiser"
            elif "(" in words and not SCOPE.search(words):
                kind = "function"
                begun = (head + BEFORE_HEAD.match(words).end(), words)
            scopes.append(kind)
            if kind == "scope":
                head = at + 1
        elif letter == "}" and scopes:
            kind = scopes.pop()
            if kind == "function":
                found = NAME.search(re.sub(r"\[\[.*?\]\]", "", begun[1]))
                name = found[1] if found else "?"
                yield name, code.count("\n", 0, begun[0]) + 1, code.count("\n", 0, at) + 1
            if kind != "initialiser":
                head = at + 1
        elif letter == ";" and not inside and not parentheses:
            head = at + 1


def sources(root: pathlib.Path) -> Iterator[pathlib.Path]:
    """Yield what people write, in order."""
    for tree in TREES:
        for file in sorted((root / tree).rglob("*")):
            name = file.relative_to(root)
            if file.suffix in SUFFIXES and not BUILT & set(name.parts) and file.is_file():
                if name.as_posix() not in GENERATED:
                    yield file


def main() -> int:
    """Print what is refused; 1 if anything is."""
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".").resolve()
    found = []
    kernels = set(KERNELS)
    count = 0
    for file in sources(root):
        name = file.relative_to(root).as_posix()
        text = file.read_text()
        count += 1
        lines = text.count("\n")
        most = LONGER.get(name, FILE_LINES)
        if lines > most:
            found.append(f"{name}: {lines} lines, more than {most}: split it by what it does")
        if file.suffix not in (".h", ".cpp") or name.split("/")[0] not in FUNCTION_TREES:
            continue
        for function, first, last in functions(text):
            length = last - first + 1
            if length <= FUNCTION_LINES:
                continue
            if (name, function) in KERNELS:
                kernels.discard((name, function))
                continue
            found.append(
                f"{name}:{first}: {function} has {length} lines, more than {FUNCTION_LINES}: "
                "give its phases names"
            )
    found += [f"{file}: {function} is not long: take it off the list" for file, function in kernels]
    if count == 0:
        found.append(f"{root}: no sources here")
    print("\n".join(found) if found else f"{count} files, none too long, nor any of their functions")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
