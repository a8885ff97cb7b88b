"""Writes the C source of the extension module from the public header.

    write_native.py --core FOLDER OUT.c

FOLDER holds the C++ project. CFFI's compiled mode has the compiler check every declaration against
the header, so a wrong one fails to build instead of corrupting memory.
"""

from __future__ import annotations

import argparse
import re
import sys
from pathlib import Path
from typing import Any

import cffi

# The one function that C calls in Python.
PROGRESS = """
extern "Python" int32_t beltrami_python_progress(void* user, double fraction, const char* stage);
"""


def read_header(core: Path) -> Any:
    """Return the public header of the C++ project in `core`, as ``abi/header.py`` reads it."""
    sys.path.insert(0, str(core / "abi"))
    import header

    return header.read(core / "include" / "beltrami" / "beltrami.h")


def exported(core: Path) -> set[str]:
    """Return the names in ``abi/symbols.txt``."""
    lines = (core / "abi" / "symbols.txt").read_text(encoding="utf-8").splitlines()
    return {line for line in lines if line and not line.startswith("#")}


def declarations(header: Any) -> str:
    """Return all declarations of the header as CFFI reads them: numbers are the compiler's."""
    items = [
        f"#define {item.name} ..." if item.kind == "macro" else item.declaration
        for item in header.items
    ]
    functions = [re.sub(r"^BELTRAMI_API\s+", "", f.declaration) for f in header.functions]
    return "\n".join(items + functions)


def main() -> None:
    """Run the program."""
    parser = argparse.ArgumentParser(description=str(__doc__).splitlines()[0])
    parser.add_argument("--core", type=Path, required=True)
    parser.add_argument("out", type=Path)
    arguments = parser.parse_args()
    header = read_header(arguments.core)
    odd = exported(arguments.core) ^ {function.name for function in header.functions}
    if odd:
        raise SystemExit(f"the header and abi/symbols.txt disagree on {', '.join(sorted(odd))}")
    builder = cffi.FFI()
    builder.cdef(declarations(header) + PROGRESS)
    builder.set_source("beltrami._native", "#include <beltrami/beltrami.h>\n")
    builder.emit_c_code(str(arguments.out))


if __name__ == "__main__":
    main()
