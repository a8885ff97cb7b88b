"""Reads the version from the C header, for scikit-build-core."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent.parent
# The C++ project: in the repository, and in an sdist.
CORES = (HERE / "native", HERE.parent.parent)


def core() -> Path:
    """Return the folder of the C++ project: in an sdist ``native``, else the repository's root."""
    return next(core for core in CORES if (core / "include/beltrami/beltrami.h").exists())


def dynamic_metadata(_settings: Mapping[str, Any], _project: Mapping[str, Any]) -> dict[str, str]:
    """Return the version as the field of the project that scikit-build-core asks for."""
    header = (core() / "include/beltrami/beltrami.h").read_text(encoding="utf-8")
    parts = re.findall(
        r"^#define BELTRAMI_VERSION_(?:MAJOR|MINOR|PATCH) (\d+)$", header, re.MULTILINE
    )
    return {"version": ".".join(parts)}
