#!/usr/bin/env python3
"""Compiles the snippets of C and C++ that the pages show.

    snippets.py ROOT C_COMPILER CXX_COMPILER

A snippet is what stands in a function of the reader's. given.h and GIVEN declare what it takes for given; functions and
specialisations in it are moved before that function. `= ...;` stands for numbers of the reader's.
"""

from __future__ import annotations

import pathlib
import re
import subprocess
import sys

BLOCK = re.compile(r"^```(c|cpp)\n(.*?)^```", re.M | re.S)
# A definition: to the brace that closes it, at the beginning of a line or on that of the definition.
DEFINITION = re.compile(r"^(?:template\b[^\n]*\};|static\b.*?^\})$", re.M | re.S)
GENERATED = "reference.md"  # declarations of the header

GIVEN = {
    "c": """\
beltrami_context* context, beltrami_surface surface, beltrami_mesh mesh, const beltrami_uv_mesh* const* meshes,
size_t mesh_count, const beltrami_surface* const* surfaces, size_t surface_count, float* uvs, beltrami_progress progress,
void* user, void* my_job_system, void* my_heap""",
    "cpp": """\
const std::vector<std::array<float, 3>>& positions, const std::vector<std::uint32_t>& triangles,
const std::vector<std::array<std::uint32_t, 2>>& edges, const TArray<FVector3f>& Vertices,
const TArray<uint32>& Triangles, beltrami::Context* Context""",
}
FLAGS = ["-fsyntax-only", "-Wall", "-Wno-unused", "-Werror"]
LANGUAGES = {"c": ["-std=c99", "-x", "c"], "cpp": ["-std=c++17", "-x", "c++", "-fno-exceptions"]}
THROWS = re.compile(r"Context\(\)|\bContext context;")  # the functions of C++ that throw


def source_of(language: str, snippet: str) -> str:
    """Return a source that has the snippet in a function, and its definitions before that."""
    snippet = snippet.replace("= ...;", ";")
    before = DEFINITION.findall(snippet)
    body = DEFINITION.sub("", snippet)
    parts = ['#include "given.h"', *before, f"void snippet({GIVEN[language]});"]
    return "\n".join([*parts, f"void snippet({GIVEN[language]}) {{{{", body, "}}", ""])


def compile_snippet(compiler: str, language: str, snippet: str, root: pathlib.Path) -> str:
    """Return what the compiler objects to."""
    flags = [
        *FLAGS,
        *LANGUAGES[language],
        "-I",
        str(root / "include"),
        "-I",
        str(root / "tests" / "docs"),
    ]
    if THROWS.search(snippet):
        flags.remove("-fno-exceptions")
    done = subprocess.run(
        [compiler, *flags, "-"],
        input=source_of(language, snippet),
        capture_output=True,
        text=True,
        check=False,
    )
    return "" if done.returncode == 0 else done.stderr


def main() -> int:
    """Compile the snippets of all pages, and print those that do not stand."""
    root = pathlib.Path(sys.argv[1])
    compilers = {"c": sys.argv[2], "cpp": sys.argv[3]}
    count = 0
    wrong = []
    for page in [root / "README.md", *sorted((root / "docs").rglob("*.md"))]:
        if page.name == GENERATED:
            continue
        text = page.read_text()
        for block in BLOCK.finditer(text):
            count += 1
            said = compile_snippet(compilers[block[1]], block[1], block[2], root)
            if said:
                line = text.count("\n", 0, block.start()) + 1
                wrong.append(f"{page.relative_to(root)}:{line}: does not compile:\n{said}")
    print("\n".join(wrong) or f"{count} snippets compile")
    return 1 if wrong or not count else 0


if __name__ == "__main__":
    sys.exit(main())
