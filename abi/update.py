#!/usr/bin/env python3
"""Rewrites what the gates compare with, after a deliberate change of the interface.

    abi/update.py header              symbols, constants, this version's frozen header, the page
    abi/update.py types --library L   the dump of the types, and what changed in it
"""
import argparse
import pathlib
import shutil
import subprocess
import sys
import tempfile

import gate
import header as public_header
import reference

HERE = gate.HERE


def update_header():
    header = public_header.read()
    symbols = sorted(function.name for function in header.functions)
    (HERE / "symbols.txt").write_text(
        "# Every function that the library exports; all export lists come from here.\n"
        "# ./dev abi rewrites it.\n" + "\n".join(symbols) + "\n", encoding="utf-8")
    found = gate.constants(public_header.HEADER, "cc")
    (HERE / "constants.txt").write_text(
        "# Every public number. ./dev abi rewrites it.\n" + "\n".join(found) + "\n",
        encoding="utf-8")
    reference.PAGE.write_text(reference.page(header), encoding="utf-8")

    values = dict(line.split() for line in found)
    version = ".".join(values[f"BELTRAMI_VERSION_{part}"] for part in ("MAJOR", "MINOR", "PATCH"))
    folder = HERE / "released" / version
    if not folder.exists():
        # The new version's client begins as the one before it.
        older = sorted(path for path in (HERE / "released").iterdir() if path.is_dir())
        shutil.copytree(older[-1], folder)
    shutil.copyfile(public_header.HEADER, folder / "beltrami" / "beltrami.h")


def update_types(library):
    committed = HERE / "types.xml"
    with tempfile.TemporaryDirectory() as scratch:
        dump = pathlib.Path(scratch) / "types.xml"
        gate.dump_types(library, public_header.HEADER, dump)
        if committed.exists():
            done = subprocess.run(["abidiff", committed, dump], capture_output=True, text=True,
                                  check=False)
            if done.returncode:
                verdict = "BREAKS old programs" if done.returncode & 8 else "changes"
                print(f"{done.stdout}\nlibabigail: this {verdict}. What that asks for: "
                      "abi/README.md")
        shutil.copyfile(dump, committed)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("what", choices=["header", "types"])
    parser.add_argument("--library", type=pathlib.Path)
    arguments = parser.parse_args()
    try:
        if arguments.what == "header":
            update_header()
        else:
            update_types(arguments.library)
    except gate.Refusal as refusal:
        sys.exit(f"abi/update.py: {refusal}")


if __name__ == "__main__":
    main()
