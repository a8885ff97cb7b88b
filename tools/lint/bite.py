"""Breaks the rules in small files, to see the checks refuse them, alone and in a group."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

from groups import groups_of, unit_of
from includes import Project, check
from lint import suspects, tidy

FILES = {
    "src/base/types.h": "#pragma once\nusing Index = int;\n"
    "template <class T> T twice(T t) { return t; }\n",
    "src/base/place.h": "#pragma once\n#define ORIGIN 0\nstruct Place { int x; };\n",
    "src/base/chain.h": '#pragma once\n#include "base/place.h"\n#include "base/types.h"\n'
    "Index next(Index i, Place p);\n",
    "include/beltrami/beltrami.hpp": "#pragma once\n#include <beltrami/cpp/part.hpp>\n",
    "include/beltrami/cpp/part.hpp": "#pragma once\nstruct Part { int x; };\n",
}
# The source, and what is said of it: the line, and the header.
CASES = {
    "chain.cpp": (
        '#include "base/chain.h"\nIndex next(Index i, Place p) { return i + p.x; }\n',
        [],
    ),
    "chain_test.cpp": ('#include "base/chain.h"\nint main() { return next(1, Place()); }\n', []),
    "missing.cpp": ('#include "base/chain.h"\nint a = next(1, {2});\nPlace b;\n', ["3: place.h"]),
    "defined.cpp": (
        '#include "base/chain.h"\n#include "base/types.h"\nIndex next(Index, Place) { return 1; }',
        ["3: place.h"],
    ),
    "idle.cpp": ('#include "base/place.h"\n#include "base/types.h"\nPlace b;\n', ["2: types.h"]),
    "macro.cpp": ('#include "base/place.h"\nint a = ORIGIN;\n', []),
    "member.cpp": ('#include "base/chain.h"\nauto f() { return &next; }\n', []),
    "part.cpp": ("#include <beltrami/beltrami.hpp>\nPart p;\n", []),
    "part_idle.cpp": ("#include <beltrami/beltrami.hpp>\nint p;\n", ["1: beltrami.hpp"]),
    "template.cpp": (
        '#include "base/chain.h"\ntemplate <class T> T g(T t) { next(1, {}); return twice(t); }\n',
        ["2: types.h"],
    ),
}
# Sources, and which of them may be read together.
HELPER = "namespace {{\nint helper() {{ return {}; }}\n}}\nint {}() {{ return helper(); }}\n"
APART = {
    "one.cpp": HELPER.format(1, "one"),
    "two.cpp": HELPER.format(2, "two"),
    "three.cpp": "struct Three {\n  Three(int x);\n};\nint helper_of_three();\n",
    "four.cpp": "namespace {\nconstexpr int kFour = 4, helper = kFour;\n}\nint four = helper;\n",
}
GROUPS = [["one.cpp", "three.cpp"], ["two.cpp"], ["four.cpp"]]
DEFECT = "three.cpp:2:3: error: single-argument constructors must be marked explicit"


def grouped(folder: Path) -> int:
    """Return 1 unless files are grouped by their names, and what is wrong is found in its file."""
    (folder / ".clang-tidy").symlink_to(Path(__file__).parents[2] / ".clang-tidy")
    for name, text in APART.items():
        (folder / name).write_text(text)
    groups = groups_of({str(folder / name): ["-std=c++20"] for name in APART})
    names = [[Path(name).name for name in group] for group in groups]
    found = "".join(tidy(unit_of(groups[0], folder), ["-std=c++20"]))
    again = suspects(groups[0], [found], Project(folder))
    if (
        names == GROUPS
        and found.count("error:") == 1
        and DEFECT in found
        and again == groups[0][1:]
    ):
        return 0
    print(f"groups.py: expected {GROUPS} and {DEFECT}, found {names} and {found}, about {again}")
    return 1


def main() -> int:
    """Return 1 if a case is judged otherwise than it should be."""
    status = 0
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder).resolve()
        for name, text in FILES.items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(text)
        for name, (text, expected) in CASES.items():
            source = root / "src" / "base" / name
            source.write_text(text)
            project = Project(root)
            found = check(
                str(source), ["-std=c++20", f"-I{root}/src", f"-I{root}/include"], "", project
            )
            short = []
            for line in found:
                header = next(h for h in FILES if h in line)
                short.append(f"{line.split(':')[1]}: {Path(header).name}")
            if short != expected:
                print(f"includes.py on {name}: expected {expected}, found {found}")
                status = 1
        status |= grouped(root / "src" / "base")
    return status


if __name__ == "__main__":
    sys.exit(main())
