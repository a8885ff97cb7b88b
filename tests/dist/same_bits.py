#!/usr/bin/env python3
"""Whether the program of another platform writes the very files that this machine's does.

    same_bits.py --native PROGRAM --stage FOLDER [--quick]

FOLDER has bin/ and lib/ of one target, as tools/dist/dist.py leaves it below build/dist/stage. It is run here: Linux
on another processor under qemu, Windows under wine. Where that is missing nothing is tested, which is said.
With --quick large meshes are flattened and checked, not unwrapped: for what is emulated.
"""

from __future__ import annotations

import argparse
import os
import platform
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
COW, BUST = ROOT / "examples/data/spot.obj", ROOT / "examples/data/nefertiti_disk.obj"
WINE = ["wine64", "/usr/lib/wine/wine64"]
# A box without a lid, in polygons, with a name that is not ASCII.
BOX = """v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nv 0 0 1\nv 2 0 1\nv 2 1 1\nv 0 1 1
f 1 2 3 4\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"""


def runner(program: Path) -> list[str] | None:
    """Return what runs a program here; None where there is nothing."""
    if program.suffix == ".exe":
        found = next((name for name in WINE if shutil.which(name)), None)
        return [found] if found else None
    machine = program.read_bytes()[18]
    names = {0x3E: "x86_64", 0xB7: "aarch64"}
    if names.get(machine) == platform.machine():
        return []
    emulator = shutil.which(f"qemu-{names.get(machine, 'none')}-static")
    root = os.environ.get("BELTRAMI_ARM_ROOT", "/usr/aarch64-linux-gnu")
    return [emulator, "-L", root] if emulator and Path(root).exists() else None


def main() -> None:
    """Run the same commands with both programs."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--native", type=Path, required=True)
    parser.add_argument("--stage", type=Path, required=True)
    parser.add_argument("--quick", action="store_true")
    arguments = parser.parse_args()
    program = next(path for path in sorted((arguments.stage / "bin").iterdir()) if path.stem == "beltrami" and path.suffix != ".dll")
    words = runner(program)
    if words is None:
        print(f"same_bits: nothing here runs {program.name} of {arguments.stage.name}: skipped")
        return
    environment = os.environ | {"WINEDEBUG": "-all"}
    with tempfile.TemporaryDirectory() as name:
        place = Path(name)
        box = place / "öut 日本.obj"
        box.write_text(BOX, encoding="utf-8")
        commands = [["unwrap", box], ["flatten", BUST]]
        if not arguments.quick:
            commands.append(["unwrap", COW, "--effort", "quick", "--threads", "2"])
        for number, command in enumerate(commands):
            outputs = []
            for who, start in (("here", [arguments.native]), ("there", [*words, program])):
                out = place / f"{who} ü {number}.obj"
                done = subprocess.run(
                    [*start, command[0], command[1], out, *command[2:], "--quiet"],
                    stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=environment, check=False,
                )
                if done.returncode or not out.exists():
                    sys.exit(f"{start}: {command}: exit code {done.returncode}: {done.stderr.decode()[-800:]}")
                outputs.append(out.read_bytes().replace(out.with_suffix("").name.encode(), b"NAME").replace(b"\r\n", b"\n"))
            if outputs[0] != outputs[1]:
                sys.exit(f"{command}: the files differ")
            print(f"same_bits: {command[0]} {command[1].name}: {len(outputs[0])} equal bytes")
        refused = subprocess.run([*words, program, "check", place / "none.obj"], stdin=subprocess.DEVNULL, capture_output=True, env=environment, check=False)
        if refused.returncode != 2:
            sys.exit(f"a missing file is to give exit code 2, not {refused.returncode}")
        told = subprocess.run([*words, program, "--version"], stdin=subprocess.DEVNULL, capture_output=True, env=environment, check=True)
        text = told.stdout.decode().strip()
        if "no LGPL code" not in text:
            sys.exit(f"it says of itself: {text}")
        print(f"same_bits: {text}")


if __name__ == "__main__":
    main()
