# SPDX-FileCopyrightText: 2026 The beltrami authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The options that operators show, out of the library's table."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from .option_table import OPTIONS, Option

TABLE = {option.name: option for option in OPTIONS}

#: Of the pages that charts are packed onto.
PAGE_OPTIONS = (
    "resolution",
    "margin",
    "texels_per_unit",
    "max_pages",
    "pack_turns",
    "pack_block",
)
UNWRAP_OPTIONS = ("energy", "hard_angle", "fill_holes", *PAGE_OPTIONS)
STRAIGHTEN_OPTIONS = ("energy", "fill_holes", *PAGE_OPTIONS)
AUTO_OPTIONS = (
    "target_energy",
    "preset",
    "effort",
    "max_charts",
    "concave_seams",
    "hidden_seams",
    "hard_seams",
    "flat_seams",
    "symmetric_seams",
    "straight_seams",
    "hard_angle",
    "fill_holes",
    "weld",
    "stack",
    "fill_weight",
    *PAGE_OPTIONS,
)

#: What a person is shown who pulls a slider; numbers beyond can be typed.
SOFT_RANGES = {
    "target_energy": (2.005, 2.5),
    "resolution": (256, 8192),
    "margin": (0, 64),
    "texels_per_unit": (0, 4096),
    "max_pages": (0, 10),
    "pack_block": (1, 8),
    "max_charts": (0, 100),
    "fill_holes": (0, 10),
    "fill_weight": (0, 50),
    "concave_seams": (0, 2),
    "hidden_seams": (0, 5),
    "hard_seams": (0.1, 2),
    "flat_seams": (0, 10),
    "symmetric_seams": (0, 2),
    "straight_seams": (0, 2),
}
#: Where Blender's users know another word than the option's own name.
LABELS = {
    "target_energy": "Distortion",
    "max_pages": "UDIM Tiles",
    "texels_per_unit": "Texel Density",
    "pack_turns": "Rotate",
    "hard_angle": "Sharp Angle",
    "max_charts": "Most Islands",
    "stack": "Stack Alike",
    "weld": "Merge Doubles",
}


@dataclass(frozen=True)
class Property:
    """What an operator has for an option.

    Attributes
    ----------
    option : Option
        Of the library.
    label : str
        As users see it.
    soft : tuple of float
        The range of the slider, within that of the option.
    """

    option: Option
    label: str
    soft: tuple[float, float]


def property_of(name: str) -> Property:
    """Return what an operator has for an option of the library, by its keyword."""
    option = TABLE[name]
    label = LABELS.get(name, name.replace("_", " ").title())
    soft = SOFT_RANGES.get(name, (option.minimum, option.maximum))
    return Property(option, label, soft)


def choice_label(choice: str) -> str:
    """Return the words for the name of a choice."""
    return choice.replace("-", " ").title()


def given(values: Mapping[str, object], call: str) -> dict[str, object]:
    """Return those of the values that a call takes, as keywords of the package.

    A value that is the library's default is left out: so a preset has its own there. Blender's
    numbers have single precision, of which seven digits are meant.

    Parameters
    ----------
    values : mapping of str to bool, int, float, str
        By keyword.
    call : {"unwrap", "pack"}
        Which function of the package.
    """
    taken: dict[str, object] = {}
    for name, value in values.items():
        option = TABLE[name]
        meant = float(f"{value:.7g}") if isinstance(value, float) else value
        takes = option.unwraps if call == "unwrap" else option.packs
        if takes and meant != option.default:
            taken[name] = meant
    return taken
