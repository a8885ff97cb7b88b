#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The beltrami authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds the extension: a zip file that Blender installs, with the wheels that it needs.

    build.py --wheel WHEEL --cffi WHEEL --out FOLDER

WHEEL is that of the Python package; the other one is that of cffi for the Python that Blender has,
as pip downloads it. The same files make the same zip, to the last bit. Prints its path.
"""

from __future__ import annotations

import argparse
import re
import zipfile
from pathlib import Path

HERE = Path(__file__).resolve().parent.parent
EXTENSION = HERE / "extension"
MANIFEST = "blender_manifest.toml"
_TIME = (2026, 1, 1, 0, 0, 0)  # of all files in the zip


def version_of(wheel: Path) -> str:
    """Return the version that a wheel's name tells."""
    return wheel.name.split("-")[1]


def manifest(wheels: list[Path]) -> str:
    """Return the manifest with the version of the package and the names of the wheels."""
    text = (EXTENSION / MANIFEST).read_text(encoding="utf-8")
    text = re.sub(r'^version = ".*"$', f'version = "{version_of(wheels[0])}"', text, flags=re.M)
    names = "".join(f'  "./wheels/{wheel.name}",\n' for wheel in wheels)
    return text.replace("\n[build]", f"\nwheels = [\n{names}]\n\n[build]", 1)


def contents(wheels: list[Path]) -> dict[str, bytes]:
    """Return the files of the zip by their names in it."""
    files = {MANIFEST: manifest(wheels).encode()}
    for path in sorted(EXTENSION.rglob("*.py")):
        files[path.relative_to(EXTENSION).as_posix()] = path.read_bytes()
    files["LICENSE"] = (HERE / "LICENSE").read_bytes()
    for wheel in wheels:
        files[f"wheels/{wheel.name}"] = wheel.read_bytes()
    return files


def build(wheels: list[Path], out: Path) -> Path:
    """Write the zip into a folder, and return its path."""
    out.mkdir(parents=True, exist_ok=True)
    path = out / f"beltrami-{version_of(wheels[0])}-linux_x64.zip"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in contents(wheels).items():
            entry = zipfile.ZipInfo(name, _TIME)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = 0o644 << 16
            archive.writestr(entry, data)
    return path


def main() -> None:
    """Run the program."""
    parser = argparse.ArgumentParser(description=str(__doc__).splitlines()[0])
    for name in ("wheel", "cffi", "out"):
        parser.add_argument(f"--{name}", type=Path, required=True)
    arguments = parser.parse_args()
    for wheel in (arguments.wheel, arguments.cffi):
        if not wheel.is_file():
            parser.error(f"there is no file {wheel}")
    print(build([arguments.wheel, arguments.cffi], arguments.out))


if __name__ == "__main__":
    main()
