"""A static library that a program of any compiler can link.

What zig compiles needs LLVM's C++ library, which the reader's compiler has not. So all objects and
what they need of it are linked into one, in which only the names of abi/symbols.txt are global.
"""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import inputs
from checks import ROOT
from targets import Target

#: zig's archives that an object needs; the C library's the reader has.
RUNTIME = re.compile(r"\S+/lib(?:c\+\+|c\+\+abi|unwind|compiler_rt)\.a")
OBJCOPY = {"x86_64-linux": "objcopy", "aarch64-linux": "aarch64-linux-gnu-objcopy"}
MACHINES = {"x86_64-linux": "elf_x86_64", "aarch64-linux": "aarch64linux"}


def close(target: Target, build: Path, library: Path) -> None:
    """Replace a plain archive by one of a single object that brings its C++ library."""
    zig = str(inputs.zig_path())
    empty, whole = build / "empty.cpp", build / "beltrami.o"
    empty.write_text("int nothing;\n")
    kind = ["-target", target.zig, "-O3", "-g0", "-fPIC", "-shared"]
    asked = [zig, "c++", *kind, "-v", str(empty), "-o", str(build / "empty.so")]
    said = subprocess.run(asked, capture_output=True, text=True, check=True, cwd=ROOT)
    linking = next(line for line in reversed(said.stderr.splitlines()) if line.startswith("ld.lld"))
    archives = RUNTIME.findall(linking)
    words = [zig, "ld.lld", "-r", "-m", MACHINES[target.name], "--force-group-allocation"]
    words += ["--whole-archive", str(library), "--no-whole-archive", *archives, "-o", str(whole)]
    subprocess.run(words, check=True, cwd=ROOT)
    keep = f"--keep-global-symbols={ROOT / 'abi' / 'symbols.txt'}"
    subprocess.run([OBJCOPY[target.name], keep, "--strip-debug", str(whole)], check=True)
    library.unlink()
    subprocess.run([zig, "ar", "rcsD", str(library), str(whole)], check=True)
