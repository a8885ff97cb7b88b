#!/usr/bin/env python3
"""Refuses an include that goes up, and circles of files, in C++, Python and Rust.

    layers.py [ROOT]

ROOT is a checkout. docs/architecture.md draws the rooms; LEVELS is that drawing in few words.
"""
from __future__ import annotations

import pathlib
import re
import sys
from collections.abc import Callable, Iterable

# From below. A room includes itself and rooms of lower levels, never its neighbours. The program
# sees the library through the public header alone.
LEVELS = [
    {"base"},
    {"mesh", "exact"},
    {"beltrami", "distortion", "scaffold", "simplify", "sparse"},
    {"fullspace"},
    {"flatten", "repair"},
    {"pipeline"},
    {"abi"},
    {"cli"},
]
ALONE = {"cli"}

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
    folder = root / "src"

    def named(file: pathlib.Path, line: str) -> list[pathlib.Path]:
        match = re.match(r'\s*#\s*include\s+"([^"]+)"', line)
        places = [folder / match[1], file.parent / match[1]] if match else []
        return [place for place in places if place.is_file()][:1]

    return graph_of(root, [*folder.rglob("*.h"), *folder.rglob("*.cpp")], named)


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


def room_of(file: str) -> str:
    """Return the folder under src that a file is in."""
    return pathlib.PurePath(file).parts[1]


def upward(graph: Graph) -> list[str]:
    """Return a sentence for every include that does not go down."""
    level = {room: i for i, rooms in enumerate(LEVELS) for room in rooms}
    found = []
    for file, edges in graph.items():
        here = room_of(file)
        if here not in level:
            found.append(f"{file}: the room '{here}' has no level in {pathlib.Path(__file__).name}")
            continue
        for other, line in edges:
            there = room_of(other)
            if there == here:
                continue
            if here in ALONE:
                found.append(f"{file}:{line}: '{here}' sees the library by its public header alone")
            elif level.get(there, len(LEVELS)) >= level[here]:
                found.append(f"{file}:{line}: '{here}' may not include '{there}', which is not below")
    return found


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
    found = upward(sources)
    for graph in (sources, python_graph(root), rust_graph(root)):
        if not graph:
            found.append(f"{root}: no sources here")
        found += circles(graph)
    print("\n".join(found) if found else "every include goes down, and there is no circle")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
