#!/usr/bin/env python3
"""Refuses an include that goes up or leads out, and circles, in C++, Python and Rust.

    layers.py [ROOT]

ROOT is a checkout. docs/design/architecture.md draws the rooms; LIBRARY and PROGRAM are that drawing in few words. In the
library a source and its header are one in a circle: whoever reads one has to read the other.
"""
from __future__ import annotations

import pathlib
import re
import sys
from collections.abc import Callable, Iterable

# From below. A room includes itself and rooms of lower levels, never its neighbours.
LIBRARY = [
    {"base"},
    {"mesh", "exact"},
    {"admit", "bake", "energy", "linear", "pack", "prolong", "ring", "simplify"},
    {"descend"},
    {"flatten", "local"},
    {"repair"},
    {"multilevel"},
    {"baselines", "pins"},
    {"chart"},
    {"cut"},
    {"atlas"},
    {"session"},
    {"abi"},
]
# In the library it alone knows the public header: statuses and the numbers of choices end there.
DOOR = "abi"
PUBLIC = "beltrami/beltrami.h"
# The program sees the library through the public header alone.
PROGRAM = [{"process"}, {"files"}, {"picture"}, {"commands"}, {"main.cpp"}]
TREES = {"src": LIBRARY, "program": PROGRAM}

Graph = dict[str, list[tuple[str, int]]]  # file -> (file, line that names it)
Named = Callable[[pathlib.Path, str], list[pathlib.Path]]


def graph_of(root: pathlib.Path, files: Iterable[pathlib.Path], named: Named) -> Graph:
    """Return for every file those that `named(file, line of text)` finds in its lines."""
    graph: Graph = {}
    for file in sorted(files):
        edges = graph.setdefault(str(file.relative_to(root)), [])
        for number, line in enumerate(file.read_text().splitlines(), 1):
            edges += [(str(place.relative_to(root)), number) for place in named(file, line)]
    return graph


def cpp_graph(root: pathlib.Path) -> Graph:
    """Return the quoted includes of every source that name a file of the sources."""

    def named(file: pathlib.Path, line: str) -> list[pathlib.Path]:
        match = re.match(r'\s*#\s*include\s+"([^"]+)"', line)
        folders = [root / tree for tree in TREES] + [file.parent]
        places = [folder / match[1] for folder in folders] if match else []
        return [place for place in places if place.is_file()][:1]

    sources = [file for tree in TREES for file in (root / tree).rglob("*") if file.is_file()]
    return graph_of(root, [file for file in sources if file.suffix in (".h", ".cpp")], named)


def python_graph(root: pathlib.Path) -> Graph:
    """Return the relative imports between the modules of the package."""
    folder = root / "bindings/python/src/beltrami"

    def named(_: pathlib.Path, line: str) -> list[pathlib.Path]:
        match = re.match(r"\s*from \.(\w*) import (.*)", line)
        names = ([match[1]] if match[1] else re.findall(r"\w+", match[2])) if match else []
        return [place for name in names if (place := folder / f"{name}.py").is_file()]

    return graph_of(root, folder.glob("*.py"), named)


def rust_graph(root: pathlib.Path) -> Graph:
    """Return the uses of one module of the safe crate by another; comments do not count."""
    folder = root / "bindings/rust/beltrami/src"

    def named(file: pathlib.Path, line: str) -> list[pathlib.Path]:
        names = re.findall(r"\bcrate::(\w+)", line.split("//")[0])
        places = [folder / f"{name}.rs" for name in names]
        return [place for place in places if place.is_file() and place != file]

    return graph_of(root, folder.rglob("*.rs"), named)


def room_of(file: str) -> tuple[str, str]:
    """Return the tree that a file is in, and its folder there."""
    tree, room = pathlib.PurePath(file).parts[:2]
    return tree, room


def upward(graph: Graph) -> list[str]:
    """Return a sentence for every include that does not go down."""
    level = {
        (tree, room): i
        for tree, levels in TREES.items()
        for i, rooms in enumerate(levels)
        for room in rooms
    }
    found = []
    for file, edges in graph.items():
        here = room_of(file)
        if here not in level:
            where = pathlib.Path(__file__).name
            found.append(f"{file}: the room '{here[1]}' has no level in {where}")
            continue
        for other, line in edges:
            there = room_of(other)
            if there == here:
                continue
            if here[0] != there[0]:
                found.append(f"{file}:{line}: the program sees the library by its header alone")
            elif level.get(there, len(level)) >= level[here]:
                found.append(
                    f"{file}:{line}: '{here[1]}' may not include '{there[1]}', which is not below"
                )
    return found


def past_the_door(root: pathlib.Path) -> list[str]:
    """Return a sentence for every include of the public header below the door."""
    found = []
    for file in sorted((root / "src").rglob("*")):
        name = str(file.relative_to(root))
        if file.suffix not in (".h", ".cpp") or room_of(name)[1] == DOOR:
            continue
        for number, line in enumerate(file.read_text().splitlines(), 1):
            match = re.match(r'\s*#\s*include\s*[<"]([^>"]+)[>"]', line)
            if match and match[1].endswith(PUBLIC):
                found.append(f"{name}:{number}: only '{DOOR}' may include <{PUBLIC}>")
    return found


def units_of(graph: Graph) -> Graph:
    """Return the same with a source of the library and its header as one."""

    def unit(file: str) -> str:
        path = pathlib.PurePath(file)
        return str(path.with_suffix("") if path.parts[0] == "src" else path)

    units: Graph = {}
    for file, edges in graph.items():
        others = [(unit(other), line) for other, line in edges]
        units.setdefault(unit(file), []).extend(edge for edge in others if edge[0] != unit(file))
    return units


def circles(graph: Graph) -> list[str]:
    """Return a sentence for a circle, found depth first, or nothing."""
    done: set[str] = set()
    for start in graph:
        path: list[str] = []
        stack = [(start, iter(graph[start]))]
        if start in done:
            continue
        path.append(start)
        while stack:
            file, edges = stack[-1]
            for other, _ in edges:
                if other in path:
                    return ["a circle: " + " -> ".join([*path[path.index(other) :], other])]
                if other not in done:
                    path.append(other)
                    stack.append((other, iter(graph.get(other, []))))
                    break
            else:
                done.add(file)
                path.pop()
                stack.pop()
    return []


def main() -> int:
    """Print what is refused; 1 if anything is."""
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".").resolve()
    sources = cpp_graph(root)
    found = upward(sources) + past_the_door(root)
    for graph in (units_of(sources), python_graph(root), rust_graph(root)):
        if not graph:
            found.append(f"{root}: no sources here")
        found += circles(graph)
    print("\n".join(found) if found else "every include goes down, and there is no circle")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
