#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The beltrami authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the extension's table of options from that of the library.

    generate.py --library LIBRARY [--check]

With --check nothing is written: the program fails where something would change.
"""

from __future__ import annotations

import argparse
import importlib.util
import sys
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent.parent
TABLE = HERE / "extension" / "uv_logic" / "option_table.py"
PYTHON_TOOLS = HERE.parent / "python" / "tools"

HEAD = '''# SPDX-FileCopyrightText: 2026 The beltrami authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The options of the library, from its own table.

Written by ``tools/generate.py``: change it there.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Option:
    """An option of the library.

    Attributes
    ----------
    name : str
        Its keyword in the Python package.
    kind : {"bool", "int", "float", "choice"}
        What its values are.
    default : bool, int, float or str
        Of a choice its name.
    minimum, maximum : float
        The range of a number.
    choices : tuple of str
        The names of choices.
    summary : str
        What it does.
    unwraps, packs : bool
        Whether unwrapping, and packing, take it.
    of_presets : bool
        Whether the option ``preset`` sets it where it is not given.
    """

    name: str
    kind: str
    default: bool | int | float | str
    minimum: float
    maximum: float
    choices: tuple[str, ...]
    summary: str
    unwraps: bool
    packs: bool
    of_presets: bool


'''


NO_FORMAT = """# Summaries stand as the library has them.
# ruff: noqa: E501
# fmt: off
"""


def row(option: Any, generate: Any) -> str:
    """Return the source of one option."""
    kind = "choice" if option.type.endswith("Choice") else option.type
    choices = option.choices if kind == "choice" else []
    names = ", ".join(f'"{choice}"' for choice in choices) + ("," if len(choices) == 1 else "")
    default = f'"{option.default}"' if isinstance(option.default, str) else repr(option.default)
    head = [f'"{option.name}"', f'"{kind}"', default, float(option.minimum), float(option.maximum)]
    calls = [bool(option.calls & call) for call in (generate.UNWRAP, generate.PACK)]
    lines = [", ".join(map(str, head)), f"({names})", f'"{option.summary}"']
    lines += [", ".join(map(str, [*calls, option.of_presets]))]
    return "    Option(\n" + "".join(f"        {line},\n" for line in lines) + "    ),\n"


def main() -> None:
    """Run the program."""
    parser = argparse.ArgumentParser(description=str(__doc__).splitlines()[0])
    parser.add_argument("--library", type=Path, required=True)
    parser.add_argument("--check", action="store_true", help="write nothing; fail where it differs")
    arguments = parser.parse_args()
    sys.path.insert(0, str(PYTHON_TOOLS))
    spec = importlib.util.spec_from_file_location("of_python", PYTHON_TOOLS / "generate.py")
    assert spec is not None
    assert spec.loader is not None
    generate = importlib.util.module_from_spec(spec)
    sys.modules["of_python"] = generate
    spec.loader.exec_module(generate)
    options = list(generate.read_options(arguments.library.resolve()))
    calls = generate.UNWRAP | generate.PACK
    rows = "".join(row(option, generate) for option in options if option.calls & calls)
    text = f"{HEAD}{NO_FORMAT}OPTIONS = (\n{rows})\n"
    if not arguments.check:
        TABLE.write_text(text, encoding="utf-8")
    elif not TABLE.exists() or TABLE.read_text(encoding="utf-8") != text:
        sys.exit(f"{TABLE.name}: not what the library says; run ./dev abi")


if __name__ == "__main__":
    main()
