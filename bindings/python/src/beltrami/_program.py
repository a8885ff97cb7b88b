"""The command-line program, which comes with the package."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path


def path() -> Path:
    """Return where the program `beltrami` of this package lies."""
    folder = Path(__file__).parent
    # Windows looks for the library beside the program.
    return folder / "beltrami.exe" if os.name == "nt" else folder / "bin" / "beltrami"


def become(arguments: list[str]) -> None:
    """Run the program in place of this process, with these arguments."""
    sys.stdout.flush()
    sys.stderr.flush()
    if os.name == "nt":  # where the caller would not wait for a process that replaces this one
        raise SystemExit(subprocess.run([path(), *arguments], check=False).returncode)
    os.execv(path(), [str(path()), *arguments])
