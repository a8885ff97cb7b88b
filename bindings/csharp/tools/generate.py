#!/usr/bin/env python3
"""Writes what the C# package repeats of the C interface, from its header and its table of options.

    generate.py --library LIBRARY [--check]

``Native.cs`` has the constants, structs and functions, ``Options.cs`` a property for each option;
and each file of the package gets the ``.meta`` file that Unity wants beside it. With --check
nothing is written: the program fails where something would change.
"""

from __future__ import annotations

import argparse
import hashlib
import re
import sys
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parents[1]
PACKAGE = HERE / "package"
ROOT = HERE.parents[1]
sys.path[:0] = [str(ROOT / "abi"), str(ROOT / "bindings" / "python" / "tools")]
import generate as python  # noqa: E402
import header as c_header  # noqa: E402

# Structs that users read have the names of the other bindings; the rest are of the C interface.
STRUCTS = {
    **python.CLASSES,
    "beltrami_result": "FlattenReport",
    "beltrami_energy": "EnergyReport",
    "beltrami_chart": "ChartReport",
    "beltrami_option_info": "NativeOptionInfo",
    "beltrami_buffer": "NativeBuffer",
    "beltrami_mesh": "NativeMesh",
    "beltrami_surface": "NativeSurface",
    "beltrami_uv_mesh": "NativeUvMesh",
    "beltrami_image": "NativeImage",
    "beltrami_bake_job": "NativeBakeJob",
    "beltrami_allocator": "NativeAllocator",
    "beltrami_baked": "NativeBaked",
    "beltrami_session": "NativeSession",
    "beltrami_session_chart": "NativeSessionChart",
}
# Enums by the word in their names; others lose "BELTRAMI_" and that word, too.
ENUMS = {"STATUS": "Status", "ELEMENT": "ElementKind", "SCALAR": "Scalar", "CALL": "Call"}
ENUMS |= {"TYPE": "OptionType", "OPTION": "Option"}
DELEGATES = (
    "beltrami_progress",
    "beltrami_job",
    "beltrami_parallel_for",
    "beltrami_allocate",
    "beltrami_release",
)
SCALARS = {
    "uint8_t": "byte",
    "int32_t": "int",
    "uint32_t": "uint",
    "int64_t": "long",
    "uint64_t": "ulong",
    "double": "double",
    "beltrami_status": "Status",
    "void": "void",
}
COLUMNS = 100
HEAD = (
    "// From the C header and the library's table of options.\n"
    "// Written by tools/generate.py: change it there.\n"
)
# GUIDs of Unity come from the place in the package, so that they stay.
META = "fileFormatVersion: 2\nguid: {guid}\n"


def pascal(name: str) -> str:
    """Return "first_bad_face" as "FirstBadFace"."""
    return "".join(word[:1].upper() + word[1:].lower() for word in re.split(r"[-_]", name) if word)


def enum_of(declaration: str) -> tuple[str, str]:
    """Return the word of an enum, and what it is called."""
    word = re.search(r"BELTRAMI_(\w+)_FORCE_SIGNED_", declaration)
    assert word, declaration
    return word[1], ENUMS.get(word[1], pascal(word[1]))


def sentence_lines(text: str, indent: str) -> list[str]:
    """Return a documentation comment."""
    if not text:
        return []
    plain = " ".join(text.split()).replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")
    lines = python.wrapped(f"<summary>{python.sentence(plain)}</summary>", f"{indent}/// ")
    return lines.split("\n")


def enum_lines(item: Any) -> list[str]:
    """Return the source of an enum."""
    word, name = enum_of(item.declaration)
    plain = c_header.without_comments(item.declaration)
    lines = [*sentence_lines(item.comment, "    "), f"    public enum {name}", "    {"]
    for member, value in re.findall(r"\bBELTRAMI_(\w+)\s*=\s*(-?\d+)", plain):
        if member.endswith("_FORCE_SIGNED_"):
            continue
        member = member.removeprefix(f"{word}_")
        lines.append(f"        {pascal(member)} = {value},")
    return [*lines, "    }", ""]


def type_of(c_type: str) -> str:
    """Return the type of a parameter."""
    c_type = c_type.replace("const ", "").replace("const*", "*").strip()
    base, stars = c_type.rstrip("* "), c_type.count("*")
    if base in DELEGATES:
        return pascal(base.removeprefix("beltrami_"))
    if base == "beltrami_context":
        return "IntPtr" + "*" * (stars - 1)
    if base == "char" or (base == "void" and stars):
        return "IntPtr" + "*" * (stars - 1)
    return (SCALARS.get(base) or STRUCTS[base]) + "*" * stars


def member_lines(declaration: str) -> list[str]:
    """Return the members of a struct."""
    body = declaration[declaration.index("{") + 1 : declaration.rindex("}")]
    body = re.sub(r"^\s*/\*.*?\*/", "", body, flags=re.DOTALL | re.MULTILINE)  # of no member alone
    member = r"([\w ]+?[ *]+)(\w+)(?:\[(\d)\])?;[ ]*(?:/\*(.*?)\*/)?"
    lines = []
    for match in re.finditer(member, body, re.DOTALL):
        c_type, name, items, comment = match[1].strip(), match[2], match[3], match[4] or ""
        comment = re.sub(r"\n\s*\*", " ", comment)
        function = c_type in DELEGATES  # a struct that is handed over as it lies has no delegates
        kind = "IntPtr" if "*" in c_type or function else type_of(c_type)
        lines += sentence_lines(comment, "        ")
        place = f"fixed {kind} {pascal(name)}[{items}]" if items else f"{kind} {pascal(name)}"
        lines.append(f"        public {place};")
    return lines


def struct_lines(item: Any) -> list[str]:
    """Return the source of a struct."""
    return [
        *sentence_lines(item.comment, "    "),
        "    [StructLayout(LayoutKind.Sequential)]",
        f"    public unsafe struct {STRUCTS[item.name]}",
        "    {",
        *member_lines(item.declaration),
        "    }",
        "",
    ]


def parameter(text: str) -> str:
    """Return a parameter: texts are ASCII, and names that C# keeps for itself get another."""
    match = re.fullmatch(r"(.*?)(\w+)", text)
    assert match, text
    name = re.sub(r"_(\w)", lambda found: found[1].upper(), match[2])
    name = {"out": "result"}.get(name, name)
    if match[1].strip() == "const char*":
        return f"string {name}"
    return f"{type_of(match[1])} {name}"


def function_lines(function: Any) -> list[str]:
    """Return the source of a function."""
    result = "IntPtr" if "*" in function.result else type_of(function.result)
    parameters = [parameter(text) for text in function.parameters]
    head = f"        public static extern {result} {function.name}("
    whole = head + ", ".join(parameters) + ");"
    if len(whole) > COLUMNS:
        whole = head + "\n            " + ",\n            ".join(parameters) + ");"
    return [
        "        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]",
        *whole.split("\n"),
        "",
    ]


def delegate_lines(item: Any) -> list[str]:
    """Return the source of the type of a function that the library calls."""
    match = re.search(r"typedef (.*?)\(\*\w+\)\((.*?)\);", " ".join(item.declaration.split()))
    assert match, item.declaration
    parameters = [
        "IntPtr stage" if text.strip() == "const char* stage" else parameter(text.strip())
        for text in match[2].split(",")
    ]
    name = pascal(item.name.removeprefix("beltrami_"))
    return [
        *sentence_lines(item.comment, "    "),
        "    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]",
        f"    public delegate {type_of(match[1])} {name}({', '.join(parameters)});",
        "",
    ]


def native(header: Any) -> str:
    """Return the source of ``Native.cs``."""
    lines = [HEAD, "using System;", "using System.Runtime.InteropServices;", ""]
    lines += ["namespace Beltrami", "{"]
    for item in header.items:
        if item.kind == "enum":
            lines += enum_lines(item)
        elif item.kind == "struct" and item.name in STRUCTS:
            lines += struct_lines(item)
        elif item.name in DELEGATES:
            lines += delegate_lines(item)
    abi = next(item for item in header.items if item.name == "BELTRAMI_ABI")
    number = abi.declaration.split()[-1]
    lines += [
        "    /// <summary>The C interface as it is: docs/reference.md says what each function",
        "    /// does.</summary>",
        "    public static unsafe class Native",
        "    {",
        "        /// <summary>libbeltrami.so, beltrami.dll or libbeltrami.dylib.</summary>",
        '        public const string Library = "beltrami";',
        "        /// <summary>The number of the binary interface that this was made for.</summary>",
        f"        public const uint Abi = {number};",
        "        /// <summary>No element, in fields of elements.</summary>",
        "        public const ulong NoElement = ulong.MaxValue;",
        "",
    ]
    for function in header.functions:
        lines += function_lines(function)
    return "\n".join(lines[:-1]) + "\n    }\n}\n"


def options(listed: list[Any]) -> str:
    """Return the source of ``Options.cs``."""
    lines = [HEAD, "namespace Beltrami", "{"]
    lines += sentence_lines("The options of a context, with what each is for", "    ")
    lines += ["    public sealed partial class Options", "    {"]
    for option in listed:
        name = pascal(option.name)
        kinds = {"bool": "bool", "int": "long", "float": "double"}
        kind = kinds.get(option.type, name)
        default = str(option.default).lower() if option.type == "bool" else option.default
        if kind == name:
            default = f"{name}.{pascal(str(option.default))}"
        preset = ", or as the preset has it" if option.of_presets else ""
        span = f" A number {option.range}." if option.range else ""
        summary = option.summary.replace("True ", "true ").replace("False ", "false ")
        text = f"{python.sentence(summary)}{span} Default: {default}{preset}"
        lines += sentence_lines(text, "        ")
        read = {
            "bool": f"Get(Option.{name}) != 0",
            "long": f"(long)Get(Option.{name})",
            "double": f"Get(Option.{name})",
        }.get(kind, f"({name})(int)Get(Option.{name})")
        write = {
            "bool": f"SetInt(Option.{name}, value ? 1 : 0)",
            "long": f"SetInt(Option.{name}, value)",
            "double": f"SetFloat(Option.{name}, value)",
        }.get(kind, f"SetInt(Option.{name}, (long)value)")
        lines += [
            f"        public {kind} {name}",
            "        {",
            f"            get {{ return {read}; }}",
            f"            set {{ {write}; }}",
            "        }",
            "",
        ]
    return "\n".join(lines[:-1]) + "\n    }\n}\n"


def metas() -> dict[Path, str]:
    """Return the ``.meta`` file of each file and folder of the package."""
    made = {}
    for path in sorted(PACKAGE.rglob("*")):
        place = path.relative_to(PACKAGE).as_posix()
        if path.suffix == ".meta" or "~" in place or "Plugins" in place:
            continue
        guid = hashlib.md5(f"beltrami/{place}".encode(), usedforsecurity=False).hexdigest()
        meta = META.format(guid=guid)
        if path.is_dir():
            meta += "folderAsset: yes\n"
        made[path.with_name(path.name + ".meta")] = meta
    return made


def main() -> None:
    """Run the program."""
    parser = argparse.ArgumentParser(description=str(__doc__).splitlines()[0])
    parser.add_argument("--library", type=Path, required=True)
    parser.add_argument("--check", action="store_true", help="write nothing; fail where it differs")
    arguments = parser.parse_args()
    made = {
        PACKAGE / "Runtime" / "Native.cs": native(c_header.read()),
        PACKAGE / "Runtime" / "Options.cs": options(list(python.read_options(arguments.library))),
    }
    stale = []
    for files in (lambda: made, metas):  # the second are of what the first has written, too
        for path, text in files().items():
            if path.exists() and path.read_text(encoding="utf-8") == text:
                continue
            stale.append(path.name)
            if not arguments.check:
                path.write_text(text, encoding="utf-8")
    if stale and arguments.check:
        sys.exit(f"bindings/csharp: {', '.join(stale)} is not what ./dev abi would write")


if __name__ == "__main__":
    main()
