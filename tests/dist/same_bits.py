#!/usr/bin/env python3
"""Whether the program of another platform writes the very files that this machine's does.

    same_bits.py --native PROGRAM --stage FOLDER [--quick]

A program in C is linked with the library of the target, too, and run.

FOLDER has bin/ and lib/ of one target, as tools/dist/dist.py leaves it below build/dist/stage. It
is run here: Linux on another processor under qemu, Windows under wine. Where that is missing
nothing is tested, which is said. With --quick large meshes are flattened, not unwrapped: for what
is emulated.
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
sys.path.insert(0, str(ROOT / "tools" / "dist"))
import inputs  # noqa: E402
from targets import TARGETS  # noqa: E402

COW, BUST = ROOT / "examples/data/spot.obj", ROOT / "examples/data/nefertiti_disk.obj"
WINE = ["wine64", "/usr/lib/wine/wine64"]
# A box without a lid, in polygons, with a name that is not ASCII.
BOX = """v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nv 0 0 1\nv 2 0 1\nv 2 1 1\nv 0 1 1
f 1 2 3 4\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"""


def wine() -> str | None:
    """Return what runs programs of Windows here, if there is something."""
    return next((name for name in WINE if shutil.which(name)), None)


def environment() -> dict[str, str]:
    """Return that of what is run, for wine with a folder of its own."""
    return os.environ | {"WINEDEBUG": "-all", "WINEPREFIX": str(ROOT / "build" / "dist" / "wine")}


def runner(program: Path) -> list[str] | None:
    """Return what runs a program here; None where there is nothing."""
    if program.suffix == ".exe":
        found = wine()
        return [found] if found else None
    machine = program.read_bytes()[18]
    names = {0x3E: "x86_64", 0xB7: "aarch64"}
    if names.get(machine) == platform.machine():
        return []
    emulator = shutil.which(f"qemu-{names.get(machine, 'none')}-static")
    root = os.environ.get("BELTRAMI_ARM_ROOT", "/usr/aarch64-linux-gnu")
    return [emulator, "-L", root] if emulator and Path(root).exists() else None


def call(
    words: list[str], place: Path, *arguments: str | Path
) -> subprocess.CompletedProcess[bytes]:
    """Run a program in a folder, with nothing to read."""
    return subprocess.run(
        [*words, *arguments],
        stdin=subprocess.DEVNULL,
        capture_output=True,
        env=environment(),
        cwd=place,
        check=False,
    )


def written(words: list[str], place: Path, command: list[str | Path], out: str) -> bytes:
    """Return the file that a command writes, without what its own name makes of it."""
    verb, mesh, *options = command
    done = call(words, place, verb, mesh, out, *options, "--quiet")
    if done.returncode or not (place / out).exists():
        said = done.stderr.decode(errors="replace")[-800:]
        sys.exit(f"{words}: {command}: exit code {done.returncode}: {said}")
    name = Path(out).stem.encode()
    return (place / out).read_bytes().replace(name, b"NAME").replace(b"\r\n", b"\n")


def compare(native: Path, words: list[str], place: Path, quick: bool) -> None:
    """Run the same commands with both programs."""
    box = "öut 日本.obj"
    (place / box).write_text(BOX, encoding="utf-8")
    commands: list[list[str | Path]] = [["unwrap", box], ["flatten", BUST]]
    if not quick:
        commands.append(["unwrap", COW, "--effort", "quick", "--threads", "2"])
    for number, command in enumerate(commands):
        here = written([str(native)], place, command, f"here ü {number}.obj")
        there = written(words, place, command, f"there ü {number}.obj")
        if here != there:
            sys.exit(f"{command}: the files differ")
        print(f"same_bits: {command[0]} {command[1]}: {len(here)} equal bytes")
    refused = call(words, place, "check", "none.obj")
    if refused.returncode != 2:
        sys.exit(f"a missing file is to give exit code 2, not {refused.returncode}")
    told = call(words, place, "--version").stdout.decode().strip()
    if "no LGPL code" not in told:
        sys.exit(f"it says of itself: {told}")
    print(f"same_bits: {told}")


def link(stage: Path, place: Path) -> Path:
    """Build the example in C as one who has nothing but the archive; return the program."""
    name = "flatten.exe" if (stage / "bin" / "beltrami.dll").exists() else "flatten"
    target = ["-target", TARGETS[stage.name].zig, f"-I{stage / 'include'}", f"-L{stage / 'lib'}"]
    words = [inputs.zig_path(), "cc", *target, ROOT / "examples/c/flatten.c", "-lbeltrami", "-lm"]
    folder = stage / ("bin" if name.endswith(".exe") else "lib")  # where the shared library is
    words += ["-Wl,-rpath," + str(folder), "-o", place / name]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(f"{stage.name}: the example in C: {done.stderr[-2000:]}")
    for library in folder.glob("*.dll"):
        shutil.copy(library, place)
    return place / name


def main() -> None:
    """Compare, where there is something that runs the program."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--native", type=Path, required=True)
    parser.add_argument("--stage", type=Path, required=True)
    parser.add_argument("--quick", action="store_true")
    arguments = parser.parse_args()
    names = [arguments.stage / "bin" / name for name in ("beltrami", "beltrami.exe")]
    program = next(path for path in names if path.exists()).resolve()
    words = runner(program)
    if words is None:
        print(f"same_bits: nothing here runs {program.name} of {arguments.stage.name}: skipped")
        return
    with tempfile.TemporaryDirectory() as place:
        compare(arguments.native.resolve(), [*words, str(program)], Path(place), arguments.quick)
        linked = link(arguments.stage.resolve(), Path(place))
        done = call([*words, str(linked)], Path(place))
        said = [line for line in done.stdout.decode().splitlines() if "injective" in line]
        if done.returncode or "NOT" in "".join(said):
            sys.exit(f"the example in C ends with {done.returncode}: {done.stderr.decode()}")
        print(f"same_bits: a program in C: {said[0]}")


if __name__ == "__main__":
    main()
