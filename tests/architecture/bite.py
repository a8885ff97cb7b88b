#!/usr/bin/env python3
"""Breaks copies of the sources to see layers.py refuse them.

    bite.py ROOT
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile

FOLDERS = ["src", "program", "bindings/python/src", "bindings/rust/beltrami/src"]

# A file, a line put before it, and what layers.py must say.
BREAKS = [
    ("src/base/types.h", '#include "mesh/disk_mesh.h"', "src/base/types.h:1: 'base' may not include"),
    ("src/repair/kernel.h", '#include "flatten/metric.h"', "'repair' may not include 'flatten'"),
    ("program/commands/report.cpp", '#include "exact/orientation.h"', "by its header alone"),
    ("src/energy/density.h", '#include "energy/energy.h"', "a circle: src/energy/"),
    ("bindings/python/src/beltrami/_errors.py", "from . import _library", "a circle: bindings/python"),
    ("bindings/rust/beltrami/src/error.rs", "use crate::mesh::Mesh;", "a circle: bindings/rust"),
]


def run(root):
    """Run the check on a tree."""
    check = pathlib.Path(__file__).with_name("layers.py")
    return subprocess.run([sys.executable, "-B", check, root], capture_output=True, text=True)


def main():
    """Exit with a sentence where a break goes unnoticed."""
    source = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name in FOLDERS:
            shutil.copytree(source / name, root / name)
        whole = run(root)
        if whole.returncode != 0:
            sys.exit(f"refused as it is:\n{whole.stdout}{whole.stderr}")
        for name, line, expected in BREAKS:
            file = root / name
            text = file.read_text()
            file.write_text(f"{line}\n{text}")
            result = run(root)
            file.write_text(text)
            if result.returncode != 1 or expected not in result.stdout:
                sys.exit(f"'{line}' in {name} went unnoticed:\n{result.stdout}{result.stderr}")
            print(f"refused: {result.stdout.splitlines()[0]}")


if __name__ == "__main__":
    main()
