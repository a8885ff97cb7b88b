"""``python -m beltrami``: the command-line program."""

from __future__ import annotations

import sys

from . import _program


def main() -> None:
    """Run the program with the arguments of this process; it takes the process over."""
    _program.become(sys.argv[1:])


if __name__ == "__main__":
    main()
