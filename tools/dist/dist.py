#!/usr/bin/env python3
"""Builds beltrami for other platforms on this machine, and packs what it has built.

    dist.py [--jobs N] [TARGET...]

TARGET is a name of targets.py, "wheels" or "npm"; without any, everything. Below build/dist each
target has a folder, whose build goes on where it was; build/dist/out gets archives, wheels, the npm
package and SHA256SUMS. The same source gives the same bytes.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import archive
import checks
import inputs
import npm
import sbom
import static_library
import wheels
from targets import TARGETS, WASM, Target
from wasm import runtime

ROOT = Path(__file__).resolve().parents[2]
DIST = ROOT / "build" / "dist"
OUT = DIST / "out"
EXTRAS = ["wheels", "npm"]


def version() -> str:
    """Return the version, such as "0.1.0", of the header."""
    header = (ROOT / "include" / "beltrami" / "beltrami.h").read_text()
    numbers = re.findall(r"#define BELTRAMI_VERSION_(?:MAJOR|MINOR|PATCH) (\d+)", header)
    return ".".join(numbers)


def say(text: str) -> None:
    """Print a line at once."""
    print(f"dist: {text}", file=sys.stderr, flush=True)


def run(*words: str | Path) -> None:
    """Run a command; its output is shown only if it fails."""
    done = subprocess.run(
        words, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False
    )
    if done.returncode:
        sys.exit(f"{done.stdout}\ndist: failed: {' '.join(map(str, words))}")


def build(target: Target, jobs: int) -> Path:
    """Configure where that was not done yet, and build; return the folder."""
    folder = DIST / target.name
    zig = inputs.zig_path()
    options = target.options | {
        "CMAKE_TOOLCHAIN_FILE": str(ROOT / "cmake" / "toolchains" / "zig.cmake"),
        "BELTRAMI_ZIG": str(zig),
        "BELTRAMI_DIST": str(inputs.gather(DIST / "sources")),
    }
    if target.name == WASM:
        place = DIST / "runtime"
        place.mkdir(parents=True, exist_ok=True)
        (place / "flags").write_text(" ".join(runtime.flags(zig)))
        (place / "machine").write_text(" ".join(runtime.MACHINE))
        runtime.build(zig, place)
        options["BELTRAMI_RUNTIME"] = str(place)
    if not (folder / "build.ninja").exists():
        say(f"configuring {target.name}, for which zig first makes its C++ library")
        defined = [f"-D{name}={value}" for name, value in options.items()]
        run("cmake", "-S", ROOT, "-B", folder, "-G", "Ninja", *defined)
    say(f"building {target.name}")
    run("ninja", "-C", folder, f"-j{jobs}")
    return folder


def pack(target: Target, folder: Path) -> Path:
    """Install into a folder of its own, check what is there, and pack it."""
    stage = DIST / "stage" / target.name
    shutil.rmtree(stage, ignore_errors=True)
    run("cmake", "--install", folder, "--prefix", stage)
    if target.static:
        library = next(stage.glob("lib*/libbeltrami.a"))
        static_library.close(target, folder, library)
    (stage / "licenses").mkdir()
    for licence in inputs.licences():
        shutil.copy(licence, stage / "licenses")
    shutil.copy(ROOT / "LICENSE", stage / "LICENSE")
    shutil.rmtree(stage / "share")
    sbom.write_sbom(stage, target, version(), sbom.kinds_of(target))
    for path in sorted(stage.rglob("*")):
        shared = path.suffix in {".dll", ".dylib"} or ".so." in path.name
        if (
            path.is_file()
            and not path.is_symlink()
            and (shared or (path.stem == "beltrami" and path.parent.name == "bin"))
        ):
            checks.check(path, shared)
    name = f"beltrami-{version()}-{target.name}"
    return archive.pack(stage, OUT / (name + target.archive), name)


def main() -> None:
    """Build what is asked for."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    parser.add_argument("what", nargs="*", metavar="TARGET", help=", ".join([*TARGETS, *EXTRAS]))
    arguments = parser.parse_args()
    unknown = [name for name in arguments.what if name not in TARGETS and name not in EXTRAS]
    if unknown:
        sys.exit(
            f"dist: there is no target '{unknown[0]}': choose of {', '.join([*TARGETS, *EXTRAS])}"
        )
    wanted = arguments.what or [*TARGETS, *EXTRAS]
    os.environ["ZIG_GLOBAL_CACHE_DIR"] = str(DIST / "zig-cache")
    OUT.mkdir(parents=True, exist_ok=True)
    made: list[Path] = []
    try:
        for name in wanted:
            if name in TARGETS and name != WASM:
                made.append(pack(TARGETS[name], build(TARGETS[name], arguments.jobs)))
        if WASM in wanted or "npm" in wanted:
            made.append(npm.pack(build(TARGETS[WASM], arguments.jobs), DIST, OUT, version()))
            made.append(npm.pack_page(DIST, OUT, version()))
        if "wheels" in wanted:
            if not any((DIST / "stage" / t.name).exists() for t in TARGETS.values() if t.wheel):
                sys.exit("dist: wheels are made of targets: name one that has some, too")
            for target in TARGETS.values():
                if target.wheel and (
                    arguments.what == [] or (DIST / "stage" / target.name).exists()
                ):
                    made.append(wheels.pack(target, DIST, OUT, version()))
    except checks.CheckError as error:
        sys.exit(f"dist: {error}")
    archive.write_sums(OUT)
    for path in made:
        say(f"{path.relative_to(ROOT)}: {path.stat().st_size / 1e6:.2f} MB")


if __name__ == "__main__":
    main()
