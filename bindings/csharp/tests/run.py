#!/usr/bin/env python3
"""Compiles the C# package with Mono, and runs its tests, its example and that of its guide.

    run.py --build BUILD_FOLDER --out FOLDER

BUILD_FOLDER has the library and the program. Unity's own interface is not to be had here: its part
of the package is compiled against stand-ins, tests/UnityStubs.cs, and run with them.
"""

from __future__ import annotations

import argparse
import importlib.util
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parents[1]
ROOT = HERE.parents[1]
_SPEC = importlib.util.spec_from_file_location("csharp_generate", HERE / "tools" / "generate.py")
assert _SPEC is not None
assert _SPEC.loader is not None
generate = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(generate)


def compile_cs(out: Path, sources: list[Path], *arguments: str) -> None:
    """Compile; any warning is a failure, but for fields that native code fills."""
    command = ["mcs", "-langversion:7", "-unsafe", "-warnaserror", f"-out:{out}", *arguments]
    subprocess.run([*command, *map(str, sources)], check=True)


def run_mono(build: Path, out: Path, *arguments: str) -> str:
    """Run a program with the library; return what it prints."""
    environment = {**os.environ, "LD_LIBRARY_PATH": str(build / "src"), "MONO_PATH": str(out)}
    done = subprocess.run(
        ["mono", *arguments], env=environment, stdout=subprocess.PIPE, text=True, check=False
    )
    if done.returncode:
        sys.exit(f"{done.stdout}\nrun.py: {arguments[0]} ended with {done.returncode}")
    return done.stdout


def layouts_in_c(out: Path) -> set[str]:
    """Return sizes and offsets of the structs, by the names of C#, as a compiler of C has them."""
    lines = ["#include <beltrami/beltrami.h>", "#include <stddef.h>", "#include <stdio.h>"]
    lines += ["int main(void) {"]
    for item in generate.c_header.read().items:
        if item.name not in generate.STRUCTS or item.kind != "struct":
            continue
        name = generate.STRUCTS[item.name]
        lines.append(f'  printf("{name} %zu\\n", sizeof({item.name}));')
        body = generate.c_header.without_comments(item.declaration)
        body = body[body.index("{") + 1 : body.rindex("}")]
        for member in re.findall(r"(\w+)(?:\[\d\])?;", body):
            shown = f"{name}.{generate.pascal(member)}"
            lines.append(f'  printf("{shown} %zu\\n", offsetof({item.name}, {member}));')
    lines += ["  return 0;", "}", ""]
    source, program = out / "layouts.c", out / "layouts"
    source.write_text("\n".join(lines), encoding="utf-8")
    include = f"-I{ROOT / 'include'}"
    subprocess.run(["cc", include, str(source), "-o", str(program)], check=True)
    return set(
        subprocess.run([program], stdout=subprocess.PIPE, text=True, check=True).stdout.split("\n")
    )


def main() -> None:
    """Run the program."""
    parser = argparse.ArgumentParser(description=str(__doc__).splitlines()[0])
    parser.add_argument("--build", type=Path, required=True)
    parser.add_argument("--out", type=Path, required=True)
    arguments = parser.parse_args()
    build, out = arguments.build.resolve(), arguments.out.resolve()
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)
    runtime = sorted((HERE / "package" / "Runtime").glob("*.cs"))
    editor = sorted((HERE / "package" / "Editor").glob("*.cs"))
    compile_cs(out / "Beltrami.dll", runtime, "-target:library")
    compile_cs(
        out / "UnwrapObj.exe", [HERE / "examples" / "UnwrapObj.cs"], f"-r:{out}/Beltrami.dll"
    )
    compile_cs(
        out / "Tests.exe",
        [*runtime, *editor, HERE / "tests" / "UnityStubs.cs", HERE / "tests" / "Tests.cs"],
        "-define:UNITY_5_3_OR_NEWER,UNITY_EDITOR",
    )
    ours, theirs = (
        set(run_mono(build, out, str(out / "Tests.exe"), "--layouts").split("\n")),
        layouts_in_c(out),
    )
    if ours != theirs:
        sys.exit(f"run.py: layouts of C# and of C differ: {sorted(ours ^ theirs)}")
    print(run_mono(build, out, str(out / "Tests.exe")), end="")
    guide = (ROOT / "docs" / "csharp.md").read_text(encoding="utf-8")
    (out / "Unwrap.cs").write_text(
        guide.split("```cs\n", 1)[1].split("```", 1)[0], encoding="utf-8"
    )
    shown = "-warnaserror-:219"  # values that a guide shows, and that nobody reads
    compile_cs(out / "Unwrap.exe", [out / "Unwrap.cs"], f"-r:{out}/Beltrami.dll", shown)
    if run_mono(build, out, str(out / "Unwrap.exe")) != "True\n":
        sys.exit("run.py: the program of docs/csharp.md does not say that its UVs are injective")
    unwrapped = out / "spot.obj"
    mesh = ROOT / "examples" / "data" / "spot.obj"
    run_mono(build, out, str(out / "UnwrapObj.exe"), str(mesh), str(unwrapped))
    subprocess.run(
        [build / "program" / "beltrami", "check", unwrapped], check=True, stdout=subprocess.DEVNULL
    )


if __name__ == "__main__":
    main()
