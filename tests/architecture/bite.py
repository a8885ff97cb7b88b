#!/usr/bin/env python3
"""Breaks copies of the sources to see the other scripts of this folder refuse them.

    bite.py ROOT
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile

FOLDERS = ["src", "program", "include", "bindings/python/src", "bindings/rust/beltrami/src"]

LONG_BODY = "  f();\n" * 69

# The check, a file, lines put before it, and what the check must say.
BREAKS = [
    (
        "layers.py", "src/base/types.h", '#include "mesh/disk_mesh.h"',
        "src/base/types.h:1: 'base' may not include",
    ),
    (
        "layers.py", "src/local/kernel.h", '#include "flatten/metric.h"',
        "'local' may not include 'flatten'",
    ),
    (
        "layers.py", "program/commands/report.cpp", '#include "exact/orientation.h"',
        "by its header alone",
    ),
    (
        "layers.py", "src/base/error.h", "#include <beltrami/beltrami.h>",
        "src/base/error.h:1: only 'abi' may include",
    ),
    (
        "layers.py", "src/atlas/atlas.cpp", '#  include "beltrami/beltrami.h"',
        "src/atlas/atlas.cpp:1: only 'abi' may include",
    ),
    ("layers.py", "src/energy/density.h", '#include "energy/energy.h"', "a circle: src/energy/"),
    # A source that includes what includes its own header.
    ("layers.py", "src/pack/outline.cpp", '#include "pack/pack.h"', "a circle: src/pack/"),
    (
        "layers.py", "bindings/python/src/beltrami/_errors.py", "from . import _library",
        "a circle: bindings/python",
    ),
    (
        "layers.py", "bindings/rust/beltrami/src/error.rs", "use crate::mesh::Mesh;",
        "a circle: bindings/rust",
    ),
    ("lengths.py", "src/base/types.h", "\n" * 600, "src/base/types.h: "),
    ("lengths.py", "include/beltrami/beltrami.h", "\n" * 1000, "include/beltrami/beltrami.h: "),
    ("lengths.py", "bindings/python/src/beltrami/plot.py", "\n" * 600, "plot.py: "),
    (
        "lengths.py", "src/ring/ring_faces.cpp", f"void f() {{\n{LONG_BODY}}}",
        "cpp:1: f has 71 lines",
    ),
    (
        "lengths.py", "program/main.cpp", f"struct A {{\n A() : a{{1}} {{\n{LONG_BODY}}}}};",
        "cpp:2: A has",
    ),
    (
        "lengths.py", "src/energy/measure.cpp", f"int g(int a = f({{}})) {{\n{LONG_BODY}}}",
        ": g has",
    ),
    (
        "numbers.py", "src/ring/ring_faces.cpp",
        "".join(f"constexpr double kOf{letter} = 1.5, k{letter} = {{2}};\n" for letter in "ABCDEFG"),
        "numbers, more than 12",
    ),
    (
        "namesakes.py", "src/ring/ring_faces.h", "namespace beltrami {\nstruct DiskMesh {};\n"
        "struct DiskMesh2 final : A<B::C> {\n};\nenum class Fault : int {\n};\n}  // namespace",
        "faces.h:5: beltrami::Fault is the name of another type, at src/base/error.h:",
    ),
]


def run(name, root):
    """Run a check on a tree."""
    check = pathlib.Path(__file__).with_name(name)
    return subprocess.run([sys.executable, "-B", check, root], capture_output=True, text=True)


def main():
    """Exit with a sentence where a break goes unnoticed."""
    source = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name in FOLDERS:
            shutil.copytree(source / name, root / name)
        for check in sorted({check for check, *_ in BREAKS}):
            whole = run(check, root)
            if whole.returncode != 0:
                sys.exit(f"{check} refused it as it is:\n{whole.stdout}{whole.stderr}")
        for check, name, lines, expected in BREAKS:
            file = root / name
            text = file.read_text()
            file.write_text(f"{lines}\n{text}")
            result = run(check, root)
            file.write_text(text)
            if result.returncode != 1 or expected not in result.stdout:
                said = f"{result.stdout}{result.stderr}"
                sys.exit(f"'{lines.strip()}' in {name} went unnoticed:\n{said}")
            print(f"refused: {result.stdout.splitlines()[0]}")


if __name__ == "__main__":
    main()
