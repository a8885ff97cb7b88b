"""A static library that a program of any compiler can link.

What zig compiles needs LLVM's C++ library, which the reader's compiler has not. So all objects and what they
need of it are linked into one, in which only the names of abi/symbols.txt are global.
"""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import inputs
from checks import ROOT
from targets import Target

#: zig's archives that an object needs; the C library's the reader has.
RUNTIME = re.compile(r"\S+/lib(?:c\+\+|c\+\+abi|unwind)\.a")
OBJCOPY = {"x86_64-linux": "objcopy", "aarch64-linux": "aarch64-linux-gnu-objcopy"}


def close(target: Target, build: Path, library: Path) -> None:
    """Replace a plain archive by one of a single object that brings its C++ library."""
    zig = str(inputs.zig_path())
    empty = build / "empty.cpp"
    empty.write_text("int main() {}\n")
    asked = [zig, "c++", "-target", target.zig, "--verbose-link", str(empty), "-o", str(build / "empty")]
    said = subprocess.run(asked, capture_output=True, text=True, check=True)
    archives = sorted(set(RUNTIME.findall(said.stdout + said.stderr)))
    whole = build / "beltrami.o"
    objects = sorted(str(path) for path in (build / "src").rglob("*.o"))
    machine = {"x86_64": "elf_x86_64", "aarch64": "aarch64linux"}[target.name.split("-")[0]]
    words = [zig, "ld.lld", "-r", "-m", machine, "--force-group-allocation", "-o", str(whole)]
    subprocess.run([*words, *objects, *archives], check=True)
    keep = f"--keep-global-symbols={ROOT / 'abi' / 'symbols.txt'}"
    subprocess.run([OBJCOPY[target.name], keep, "--strip-debug", str(whole)], check=True)
    library.unlink()
    subprocess.run([zig, "ar", "rcsD", str(library), str(whole)], check=True)
