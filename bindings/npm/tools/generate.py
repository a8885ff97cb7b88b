#!/usr/bin/env python3
"""Writes what the npm package repeats of the C interface, from its header and its table of options.

    generate.py --library LIBRARY [--check]

``tables.mjs`` has the layouts of structs as WebAssembly has them, and the options; ``index.d.ts``
has the types of options and results, after ``types.d.ts``. With --check nothing is written: the
program fails where something would change.
"""

from __future__ import annotations

import argparse
import json
import re
import sys
from pathlib import Path
from typing import Any

PACKAGE = Path(__file__).resolve().parents[1]
ROOT = PACKAGE.parents[1]
sys.path[:0] = [str(ROOT / "abi"), str(ROOT / "bindings" / "python" / "tools")]
import generate as python  # noqa: E402
import header as c_header  # noqa: E402

# Bytes of the types of members in WebAssembly, which are their alignments, too, but for buffers.
SIZES = {"uint32_t": 4, "int32_t": 4, "beltrami_status": 4, "uint64_t": 8, "double": 8}
BUFFER = ("beltrami_buffer", 24, 8)
KINDS = {"uint32_t": "u32", "int32_t": "i32", "beltrami_status": "i32"}
# What the package passes or reads.
STRUCTS = [
    "beltrami_option_info",
    "beltrami_mesh",
    "beltrami_surface",
    "beltrami_uv_mesh",
    *python.CLASSES,
    "beltrami_session",
    "beltrami_session_chart",
]
STRUCTS.remove("beltrami_stage")
# As TypeScript has them.
RESULTS = {
    "beltrami_certificate": "Certificate",
    "beltrami_energy": "Energy",
    "beltrami_result": "FlattenReport",
    "beltrami_atlas": "AtlasReport",
    "beltrami_chart": "Chart",
    "beltrami_atlas_certificate": "AtlasCertificate",
    "beltrami_packing": "PackingReport",
}
LEFT_OUT = {"threads"}  # there is one
BOOLEANS = {"injective", "searched", "reached", "due", "locked"}
HIDDEN = {"struct_size", "reserved", "status", "error_element", "error_element_kind"}


def camel(name: str) -> str:
    """Return a name of C as JavaScript has it: "first_bad_face" as "firstBadFace"."""
    first, *others = re.split(r"[-_]", name)
    return first + "".join(word.capitalize() for word in others)


def layout(declaration: str) -> dict[str, Any]:
    """Return the size of a struct, and for each member its offset, its kind and how many it has."""
    body = c_header.without_comments(declaration)
    body = body[body.index("{") + 1 : body.rindex("}")]
    members: dict[str, list[Any]] = {}
    at, greatest = 0, 4
    for match in re.finditer(r"(const \w+|\w+)\s*(\*?)\s*(\w+)(?:\[(\d)\])?;", body):
        c_type, pointer, name, count = match[1], match[2], match[3], int(match[4] or 1)
        if pointer:
            size, align, kind = 4, 4, "text" if "char" in c_type else "pointer"
        elif c_type == BUFFER[0]:
            size, align, kind = BUFFER[1], BUFFER[2], "buffer"
        else:
            size = align = SIZES[c_type]
            kind = KINDS.get(c_type, {"uint64_t": "u64", "double": "f64"}.get(c_type, ""))
            kind = "bool" if name in BOOLEANS and c_type == "int32_t" else kind
        at = -(-at // align) * align
        members[name] = [at, kind] if count == 1 else [at, kind, count]
        at += size * count
        greatest = max(greatest, align)
    return {"size": -(-at // greatest) * greatest, "members": members}


def tables(options: list[Any], header: Any) -> str:
    """Return the source of ``tables.mjs``."""
    declarations = {item.name: item.declaration for item in header.items}
    layouts = {name: layout(declarations[name]) for name in STRUCTS}
    names = {
        camel(option.name): [option.name.replace("_", "-"), option.calls]
        for option in options
        if option.name not in LEFT_OUT
    }
    lines = [
        "// Structs as WebAssembly has them, and options: from the C header and the option table.",
        "// Written by tools/generate.py: change it there.",
        "",
        "export const layouts = {",
        *(f"  {name}: {json.dumps(made)}," for name, made in layouts.items()),
        "};",
        "",
        "/** By the name in JavaScript: the name in C, and the sum of the calls that take it. */",
        "export const options = {",
        *(f"  {name}: {json.dumps(of)}," for name, of in names.items()),
        "};",
        "",
    ]
    return "\n".join(lines)


def option_lines(options: list[Any], call: int) -> list[str]:
    """Return the members of the interface of the options that a call takes."""
    lines = []
    for option in options:
        if not option.calls & call or option.name in LEFT_OUT:
            continue
        kind = {"bool": "boolean", "int": "number", "float": "number"}.get(option.type)
        kind = kind or " | ".join(f"'{choice}'" for choice in option.choices)
        default = str(option.default).lower() if option.type == "bool" else option.default
        default = f"{default:g}" if isinstance(default, float) else default
        span = f" A number {option.range}." if option.range else ""
        preset = ", or as the preset has it" if option.of_presets else ""
        lines.append(f"  /** {option.summary}{span} Default: {default}{preset}. */")
        lines.append(f"  {camel(option.name)}?: {kind};")
    return lines


def result_lines(struct: str, declaration: str) -> list[str]:
    """Return the interface of a struct of results."""
    name = RESULTS[struct]
    words = python.WORDS.get(python.CLASSES[struct], {})
    lines = [f"/** {python.SUMMARIES[python.CLASSES[struct]]} */", f"export interface {name} {{"]
    hidden = HIDDEN - {"status"} if struct == "beltrami_chart" else HIDDEN
    for field in python.read_fields(declaration, hidden):
        kind = {"str": "string", "float": "number", "int": "number", "bool": "boolean"}.get(
            field.type
        )
        if kind is None and field.type.startswith("tuple[float"):
            kind = "number[]"
        if kind is None:
            kind = "[number, number] | null" if "tuple" in field.type else "number | null"
        comment = words.get(field.name, field.comment).replace("None", "null")
        if comment:
            lines.append(f"  /** {python.sentence(comment)} */")
        lines.append(f"  readonly {camel(field.name)}: {kind};")
    return [*lines, "}", ""]


def types(options: list[Any], header: Any) -> str:
    """Return the source of ``index.d.ts``."""
    declarations = {item.name: item.declaration for item in header.items}
    lines = [
        (PACKAGE / "types.d.ts").read_text(encoding="utf-8"),
        "// What follows is written by tools/generate.py: from the C header and the option table.",
        "",
    ]
    calls = {
        "FlattenOptions": python.RUN,
        "UnwrapOptions": python.UNWRAP,
        "PackOptions": python.PACK,
    }
    for name, call in calls.items():
        lines += [
            f"export interface {name} extends Running {{",
            *option_lines(options, call),
            "}",
            "",
        ]
    for struct in RESULTS:
        lines += result_lines(struct, declarations[struct])
    return "\n".join(lines)


def main() -> None:
    """Run the program."""
    parser = argparse.ArgumentParser(description=str(__doc__).splitlines()[0])
    parser.add_argument("--library", type=Path, required=True)
    parser.add_argument("--check", action="store_true", help="write nothing; fail where it differs")
    arguments = parser.parse_args()
    options, header = list(python.read_options(arguments.library)), c_header.read()
    stale = []
    made = {"tables.mjs": tables(options, header), "index.d.ts": types(options, header)}
    for name, text in made.items():
        path = PACKAGE / name
        if path.exists() and path.read_text(encoding="utf-8") == text:
            continue
        stale.append(name)
        if not arguments.check:
            path.write_text(text, encoding="utf-8")
    if stale and arguments.check:
        sys.exit(f"bindings/npm: {', '.join(stale)} is not what ./dev abi would write")


if __name__ == "__main__":
    main()
