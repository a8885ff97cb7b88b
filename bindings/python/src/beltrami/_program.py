"""The command-line program, which comes with the package."""

from __future__ import annotations

import os
import sys
from pathlib import Path


def path() -> Path:
    """Return where the program `beltrami` of this package lies."""
    name = "beltrami.exe" if os.name == "nt" else "beltrami"
    return Path(__file__).parent / "bin" / name


def become(arguments: list[str]) -> None:
    """Run the program in place of this process, with these arguments."""
    sys.stdout.flush()
    sys.stderr.flush()
    os.execv(path(), [str(path()), *arguments])
