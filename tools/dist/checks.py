"""What a binary exports and needs, held to lists: a check that reads the file, and runs nothing."""

from __future__ import annotations

import re
import struct
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
#: Shared libraries that every system of a kind has.
ELF_NEEDS = re.compile(r"lib(c|m|pthread|dl|beltrami)\.so\.\d+|ld-linux-\S+|libc\.so")  # of musl
#: Windows 10 and later have the universal C library.
PE_NEEDS = re.compile(r"KERNEL32\.dll|ntdll\.dll|api-ms-win-crt-\S+\.dll|beltrami\.dll", re.I)
OF_EVERY_DYLIB = {"__dso_handle", "_mh_dylib_header"}
MACHO_NEEDS = re.compile(r"/usr/lib/libSystem\.B\.dylib|@rpath/libbeltrami\.\S+")
OLDEST_GLIBC = (2, 17)


class CheckError(Exception):
    """A binary is not what it is to be."""


def symbols() -> set[str]:
    """Return the functions that a library is to export, and no others."""
    lines = (ROOT / "abi" / "symbols.txt").read_text().splitlines()
    return {line for line in lines if line and not line.startswith("#")}


def check(path: Path, is_library: bool) -> None:
    """Raise CheckError where a binary exports or needs something else than it should."""
    magic = path.read_bytes()[:4]
    if magic == b"\x7fELF":
        needs, exports = _of_elf(path)
        allowed = ELF_NEEDS
    elif magic[:2] == b"MZ":
        needs, exports = _of_pe(path)
        allowed = PE_NEEDS
    else:
        needs, exports = _of_macho(path)
        allowed = MACHO_NEEDS
    strange = sorted(name for name in needs if not allowed.fullmatch(name))
    if strange:
        raise CheckError(f"{path.name} needs {', '.join(strange)}, which not every system has")
    wanted = symbols() if is_library else set()
    if is_library and exports != wanted:
        raise CheckError(
            f"{path.name} exports what it should not, or not what it should: "
            + ", ".join(sorted(exports ^ wanted)[:10])
        )


def _run(*words: str | Path) -> str:
    return subprocess.run(words, capture_output=True, text=True, check=True).stdout


def _of_elf(path: Path) -> tuple[list[str], set[str]]:
    needs = re.findall(r"\(NEEDED\).*\[(.*)\]", _run("readelf", "-dW", path))
    table = _run("readelf", "--dyn-syms", "-W", path)
    for version in re.findall(r"@GLIBC_([0-9.]+)", table):
        if tuple(map(int, version.split("."))) > OLDEST_GLIBC:
            raise CheckError(f"{path.name} needs glibc {version}")
    defined = r"(?:FUNC|OBJECT)\s+(?:GLOBAL|WEAK)\s+DEFAULT\s+\d+ (\w+)"
    return needs, set(re.findall(defined, table))


def _of_pe(path: Path) -> tuple[list[str], set[str]]:
    text = _run("objdump", "-p", path)
    needs = re.findall(r"DLL Name: (\S+)", text)
    names = text.partition("[Ordinal/Name Pointer] Table")[2]
    return needs, set(re.findall(r"^\s*\[\s*\d+\].*?\s(\w+)$", names, re.M))


def _of_macho(path: Path) -> tuple[list[str], set[str]]:
    data = path.read_bytes()
    if data[:4] != b"\xcf\xfa\xed\xfe":
        raise CheckError(f"{path.name} is of no known format")
    count = struct.unpack_from("<I", data, 16)[0]
    needs, exports, at = [], set(), 32
    load_dylib, symtab = 0xC, 0x2
    for _ in range(count):
        command, size = struct.unpack_from("<II", data, at)
        if command == load_dylib:
            begin = at + struct.unpack_from("<I", data, at + 8)[0]
            needs.append(data[begin : data.index(b"\0", begin)].decode())
        elif command == symtab:
            table, symbols_, text, _size = struct.unpack_from("<IIII", data, at + 8)
            for i in range(symbols_):
                name, kind, section = struct.unpack_from("<IBB", data, table + 16 * i)
                if kind & 0x01 and not kind & 0x10 and section:  # external, not private, defined
                    begin = text + name
                    exports.add(data[begin + 1 : data.index(b"\0", begin)].decode())
        at += size
    return needs, exports - OF_EVERY_DYLIB
