#!/usr/bin/env python3
"""Writes what the package repeats of the C interface, from its header and its table of options.

    generate.py --library LIBRARY [--check]

All of ``_tables.py`` (choices, options, the classes of results), and in the functions that take
options their parameters, the section "Options" of their docstrings, and the passing on of their
values. With --check nothing is written: the program fails where something would change. Lines come
out as the formatter leaves them.
"""

from __future__ import annotations

import argparse
import ctypes
import dataclasses
import re
import sys
import textwrap
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from header_version import core

PACKAGE = Path(__file__).resolve().parent.parent / "src" / "beltrami"
COLUMNS = 100

# The structs of the header that become classes, with what else a class has.
CLASSES = {
    "beltrami_certificate": "Certificate",
    "beltrami_energy": "Energy",
    "beltrami_result": "Report",
    "beltrami_stage": "Stage",
    "beltrami_atlas": "AtlasReport",
    "beltrami_chart": "Chart",
    "beltrami_atlas_certificate": "AtlasCertificate",
    "beltrami_packing": "PackingReport",
}
SUMMARIES = {
    "Certificate": "The exact verdict on a map; true where nothing bad was found.",
    "Energy": "Distortion energies of a map: means over the faces weighted by area in space.",
    "Report": "Counts, area and cost of a run.",
    "Stage": "What one stage of a run took.",
    "AtlasReport": "What was made of a surface: counts, energy and cost.",
    "Chart": "A chart of an atlas: a connected piece of the surface.",
    "AtlasCertificate": "The exact verdict on an atlas; true where it is injective.",
    "PackingReport": "What lies on the pages of a texture: counts, density, margin and cost.",
}
METHODS = {
    "Certificate": '''
    def __bool__(self) -> bool:
        """Whether no face is flipped or without area, and the boundary nowhere crosses itself."""
        return self.negative == self.degenerate == self.boundary_crossings == 0
''',
    "AtlasCertificate": '''
    def __bool__(self) -> bool:
        """Whether the atlas is injective."""
        return self.injective
''',
}
# Fields that serve the C interface only; the status is the result's own, but for that of a chart.
LEFT_OUT = {"struct_size", "reserved", "error_element", "error_element_kind"}
WITH_STATUS = {"beltrami_chart"}
# Comments that speak of C.
COMMENTS = {
    "1 or 0": "whether the map is proven to be injective",
    "OK, NOT_CONVERGED, NOT_INJECTIVE or NOT_INJECTIVE_FLOAT32": (
        '"BELTRAMI_OK", "BELTRAMI_NOT_CONVERGED", "BELTRAMI_NOT_INJECTIVE" or '
        '"BELTRAMI_NOT_INJECTIVE_FLOAT32"'
    ),
    "why it has no map but one point, e.g. SOLVER; else OK": (
        'why it has no map but one point, e.g. "BELTRAMI_E_SOLVER"; else "BELTRAMI_OK"'
    ),
    'static: "simplify", "coarse", "prolong", "flatten", "repair", ...': (
        '"simplify", "coarse", "prolong", "flatten", "repair", ...'
    ),
}
# What the header says by the fields before, or nowhere.
WORDS = {
    "AtlasReport": {
        "corners": "of its faces",
        "triangles": "of `triangulate`: what is computed on",
        "charts": "pieces of the layout",
        "unused_vertices": "vertices that no face names",
        "welded_vertices": "vertices that count as one with a vertex before them",
        "crowded_edges": "edges of more than two triangles, where flat sheets stay whole",
        "one_sided_edges": "edges where the sides of a one-sided surface part",
        "split_vertices": "vertices where fans of faces met in one point only",
        "components": "connected pieces of the surface",
        "closed_components": "those without a boundary",
        "symmetric_dirichlet": "mean energy over the area, at one scale for all: >= 2",
        "p99": "energy that is exceeded on 1% of the area at most",
        "max": "greatest energy of a triangle",
        "seams": "edges in `Atlas.seams`",
        "searched": 'whether seams were searched for: with cut="auto"',
        "reached": (
            "whether those meet what was asked for: energy (to 0.0001), p99, charts (or one for "
            "each component), seam length"
        ),
        "pages": "0 where the atlas is not packed: `Atlas.packing` has the rest",
    },
    "PackingReport": {
        "charts": "pieces that were moved",
        "triangles": "faces of all charts",
        "pages": "square pages of a texture",
    },
    "Chart": {
        "triangles": "of the surface",
        "first_face": "the least face of the input",
        "max": "greatest energy of a triangle",
    },
    "AtlasCertificate": {
        "injective": "whether all triangles are positive, and no two overlap",
        "excepted": "triangles not judged: without area on the surface, or sharing UVs",
        "mirrored_charts": "charts that were negative as a whole, taken as their mirror images",
    },
}


@dataclasses.dataclass
class Option:
    """An option of the library's table."""

    name: str  # as a Python keyword
    type: str  # "bool", "int", "float", or the name of a Literal
    default: object
    range: str  # "" for switches and choices
    choices: list[str]
    summary: str
    calls: int  # sum of the CALL_ numbers of those that take it
    of_presets: bool  # whether the option "preset" sets it
    minimum: float
    maximum: float

    @property
    def annotated(self) -> str:
        """The parameter with its type and default; None for what a preset may set."""
        if self.of_presets:
            return f"{self.name}: {self.type} | None = None"
        default = f'"{self.default}"' if isinstance(self.default, str) else repr(self.default)
        return f"{self.name}: {self.type} = {default}"


class _OptionInfo(ctypes.Structure):
    """``beltrami_option_info`` of the C header."""

    _fields_ = [
        ("struct_size", ctypes.c_uint32),
        ("key", ctypes.c_int32),
        ("type", ctypes.c_int32),
        ("reserved", ctypes.c_int32),
        ("minimum", ctypes.c_double),
        ("maximum", ctypes.c_double),
        ("default_value", ctypes.c_double),
        ("name", ctypes.c_char_p),
        ("summary", ctypes.c_char_p),
        ("calls", ctypes.c_int32),
        ("reserved_2", ctypes.c_int32),
    ]


ABI = 1  # BELTRAMI_ABI
INT, FLOAT, CHOICE = range(3)  # BELTRAMI_TYPE_
RUN, UNWRAP, PACK = 1, 2, 4  # BELTRAMI_CALL_


def read_options(library: Path) -> Iterator[Option]:
    """Yield the options of the shared library, in the order of their keys."""
    beltrami = ctypes.CDLL(str(library))
    beltrami.beltrami_option_choice.restype = ctypes.c_char_p
    of_presets = _keys_of_presets(beltrami)
    key = 0
    while True:
        info = _OptionInfo(struct_size=ctypes.sizeof(_OptionInfo))
        if beltrami.beltrami_option_describe(key, ctypes.byref(info)) != 0:
            return
        choices: list[str] = []
        while choice := beltrami.beltrami_option_choice(key, len(choices)):
            choices.append(choice.decode())
        yield _option(info, choices, key in of_presets)
        key += 1


def _keys_of_presets(beltrami: ctypes.CDLL) -> set[int]:
    """Return the keys of the options that the option "preset" sets."""
    context = ctypes.c_void_p()
    if beltrami.beltrami_create_(ABI, ctypes.byref(context)) != 0:
        sys.exit(f"the library has no ABI {ABI}")
    preset = beltrami.beltrami_option_find(b"preset")

    def values() -> dict[int, float]:
        found: dict[int, float] = {}
        value = ctypes.c_double()
        while beltrami.beltrami_get_option(context, len(found), ctypes.byref(value)) == 0:
            found[len(found)] = value.value
        return found

    defaults = values()
    keys: set[int] = set()
    choice = 0
    while beltrami.beltrami_set_int(context, preset, ctypes.c_int64(choice)) == 0:
        keys |= {key for key, value in values().items() if value != defaults[key]}
        choice += 1
    beltrami.beltrami_destroy(context)
    return keys - {preset}


def _option(info: Any, choices: list[str], of_presets: bool) -> Option:
    name = info.name.decode().replace("-", "_")
    summary = info.summary.decode()
    default: object
    if choices == ["off", "on"] or (info.type == INT and (info.minimum, info.maximum) == (0, 1)):
        kind, default, span = "bool", bool(info.default_value), ""
        summary = re.sub(r"^(1|on) ", "True ", summary).replace("; 0 ", "; False ")
    elif info.type == CHOICE:
        kind, default, span = _camel(name) + "Choice", choices[int(info.default_value)], ""
    else:
        kind = "float" if info.type == FLOAT else "int"
        default = info.default_value if info.type == FLOAT else int(info.default_value)
        span = f"from {info.minimum:,.10g} to {info.maximum:,.10g}"
    span_of = (info.minimum, info.maximum)
    return Option(name, kind, default, span, choices, summary, info.calls, of_presets, *span_of)


def _camel(name: str) -> str:
    return "".join(word.capitalize() for word in name.split("_"))


@dataclasses.dataclass
class Field:
    """A member of a struct of the header."""

    name: str
    type: str
    comment: str


def read_fields(declaration: str, left_out: set[str]) -> Iterator[Field]:
    """Yield the members of a struct that users see."""
    body = declaration[declaration.index("{") + 1 : declaration.rindex("}")]
    member = r"([\w ]+?[ *]+)(\w+)(?:\[(\d)\])?;[ ]*(?:/\*(.*?)\*/)?"
    for match in re.finditer(member, body, re.DOTALL):
        c_type, name, items, comment = match[1].strip(), match[2], match[3], match[4] or ""
        comment = re.sub(r"\n\s*\*", " ", comment).replace("BELTRAMI_NO_ELEMENT", "None")
        comment = " ".join(comment.split())
        comment = COMMENTS.get(comment, comment)
        if name not in left_out:
            yield Field(name, _python_type(c_type, name, int(items or 1), comment), comment)


def _python_type(c_type: str, name: str, items: int, comment: str) -> str:
    if "char" in c_type or c_type == "beltrami_status":
        return "str"
    if c_type == "double":
        return "float" if items == 1 else f"tuple[{', '.join(['float'] * items)}]"
    if name in ("injective", "searched", "reached"):
        return "bool"
    element = "int | None" if "None" in comment else "int"
    return "tuple[int, int] | None" if items == 2 else element


def wrapped(text: str, indent: str) -> str:
    """Return `text` in lines of at most `COLUMNS`, all indented."""
    return textwrap.fill(
        text,
        COLUMNS,
        initial_indent=indent,
        subsequent_indent=indent,
        break_on_hyphens=False,
        break_long_words=False,
    )


def sentence(text: str) -> str:
    """Return `text` with a capital and a full stop."""
    return text[:1].upper() + text[1:] + ("" if text.endswith(".") else ".")


def class_of(name: str, fields: list[Field]) -> str:
    """Return the source of the class for a struct."""
    words = WORDS.get(name, {})
    fields = [dataclasses.replace(f, comment=words.get(f.name, f.comment)) for f in fields]
    entries: list[list[Field]] = []
    for field in fields:  # a comment is about the uncommented members after it, too
        if field.comment or not entries:
            entries.append([])
        entries[-1].append(field)
    lines = [
        "@dataclass(frozen=True)",
        f"class {name}:",
        f'    """{SUMMARIES[name]}',
        "",
        "    Attributes",
        "    ----------",
    ]
    for entry in entries:
        lines.append(f"    {', '.join(field.name for field in entry)} : {entry[0].type}")
        lines.append(wrapped(sentence(entry[0].comment or entry[0].name), " " * 8))
    lines += ['    """', ""]
    lines += [f"    {field.name}: {field.type}" for field in fields]
    return "\n".join(lines) + "\n" + METHODS.get(name, "")


def literal(option: Option) -> str:
    """Return the alias for the choices of an option, as the formatter breaks it."""
    items = [f'"{choice}"' for choice in option.choices]
    line = f"{option.type} = Literal[{', '.join(items)}]"
    return line if len(line) <= COLUMNS else f"{option.type} = Literal[\n    {', '.join(items)}\n]"


def tables(options: list[Option], header: Any) -> str:
    """Return the source of ``_tables.py``."""
    declarations = {item.name: item.declaration for item in header.items}
    choices = [literal(option) for option in options if option.type.endswith("Choice")]
    classes = []
    for struct, name in CLASSES.items():
        left_out = LEFT_OUT if struct in WITH_STATUS else LEFT_OUT | {"status"}
        classes.append(class_of(name, list(read_fields(declarations[struct], left_out))))
    return (
        '"""Options and results, from the C header and the library\'s table of options.\n\n'
        'Written by ``tools/generate.py``: change it there.\n"""\n\n'
        "from __future__ import annotations\n\n"
        "from dataclasses import dataclass\nfrom typing import Literal, TypedDict\n\n"
        + "\n".join(choices)
        + "\n\n"
        + "#: Options that None leaves to the option `preset`.\n"
        + names_of_presets(options)
        + "\n\n"
        + keywords("Options", "The options of a run", options, RUN)
        + keywords("UnwrapOptions", "The options of `unwrap`", options, UNWRAP)
        + keywords("PackOptions", "The options of `pack`", options, PACK)
        + "\n\n".join(classes)
    )


def names_of_presets(options: list[Option]) -> str:
    """Return the source of the tuple of options that presets set, as the formatter breaks it."""
    names = [f'"{option.name}"' for option in options if option.of_presets]
    line = f"OF_PRESETS = ({', '.join(names)})\n"
    if len(line) <= COLUMNS:
        return line
    return "OF_PRESETS = (\n" + "".join(f"    {name},\n" for name in names) + ")\n"


def keywords(name: str, what: str, options: list[Option], call: int) -> str:
    """Return the source of the type of the keywords of a call."""
    lines = [f"    {option.name}: {option.type}\n" for option in options if option.calls & call]
    head = (
        f'class {name}(TypedDict, total=False):\n    """{what} by keyword, all of them optional."""'
    )
    return f"{head}\n\n{''.join(lines)}\n\n"


def documentation(options: list[Option], indent: str) -> str:
    """Return the entries of the options in the style of NumPy's docstrings."""
    lines = []
    for option in options:
        kind = option.type
        if option.choices and kind != "bool":
            kind = "{" + ", ".join(f'"{choice}"' for choice in option.choices) + "}"
        default = f'"{option.default}"' if isinstance(option.default, str) else option.default
        preset = ", or as the preset has it" if option.of_presets else ""
        head = f"{indent}{option.name} : {kind}, default {default}{preset}"
        text = option.summary + (f" A number {option.range}." if option.range else "")
        if len(head) > COLUMNS:
            head = f"{indent}{option.name} : str, default {default}{preset}"
            text = f"One of {kind[1:-1]}. {text}"
        lines.append(head)
        lines.append(wrapped(text, indent + "    "))
    return "\n".join(lines) + "\n"


MARKED = re.compile(r"^( *)# options: (\w+)\n.*?^\1# end of options\n", re.DOTALL | re.MULTILINE)
SECTION = re.compile(r"^( *)Options\n\1-------\n.*?(?=\n\1[A-Z]\w+\n\1---|\1\"\"\")", re.M | re.S)


def with_options(source: str, of_all_calls: list[Option]) -> str:
    """Return the source of a module with its places for options filled anew.

    A module has the options of one call: with ``# call: unwrap`` of that, else of a run.
    """
    marked = re.search(r"^# call: (\w+)$", source, re.MULTILINE)
    call = {"unwrap": UNWRAP, "pack": PACK}[marked[1]] if marked else RUN
    options = [option for option in of_all_calls if option.calls & call]
    inside: dict[str, Callable[[Option], str]] = {
        "parameters": lambda option: option.annotated,
        "keywords": lambda option: f"{option.name}={option.name}",
        "items": lambda option: f'"{option.name}": {option.name}',
    }

    def fill(match: re.Match[str]) -> str:
        indent, kind = match[1], match[2]
        lines = "".join(f"{indent}{inside[kind](option)},\n" for option in options)
        return f"{indent}# options: {kind}\n{lines}{indent}# end of options\n"

    def describe(match: re.Match[str]) -> str:
        indent = match[1]
        return f"{indent}Options\n{indent}-------\n" + documentation(options, indent)

    return SECTION.sub(describe, MARKED.sub(fill, source))


def main() -> None:
    """Run the program."""
    parser = argparse.ArgumentParser(description=str(__doc__).splitlines()[0])
    parser.add_argument("--library", type=Path, required=True)
    parser.add_argument("--check", action="store_true", help="write nothing; fail where it differs")
    arguments = parser.parse_args()
    sys.path.insert(0, str(core() / "abi"))
    import header

    options = list(read_options(arguments.library))
    wanted = {PACKAGE / "_tables.py": tables(options, header.read())}
    for path in sorted(PACKAGE.glob("*.py")):
        if "# options: " in (source := path.read_text(encoding="utf-8")):
            wanted[path] = with_options(source, options)
    stale = [
        path
        for path, text in wanted.items()
        if not path.exists() or path.read_text(encoding="utf-8") != text
    ]
    if not arguments.check:
        for path in stale:
            path.write_text(wanted[path], encoding="utf-8")
    elif stale:
        names = ", ".join(path.name for path in stale)
        sys.exit(f"{names}: not what the C interface says; run ./dev abi")


if __name__ == "__main__":
    main()
