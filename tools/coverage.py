"""Prints what the tests ran of each room: lines and branches, in a table.

    coverage.py SUMMARY.json

SUMMARY.json is what gcovr writes with --json-summary.
"""

from __future__ import annotations

import json
import sys
from collections import Counter
from pathlib import Path


def room_of(filename: str) -> str:
    """Return the folder of a source below the root, two deep at most."""
    return "/".join(Path(filename).parts[:-1][:2])


def main() -> None:
    """Print the table."""
    summary = json.loads(Path(sys.argv[1]).read_text())
    rooms: dict[str, Counter[str]] = {}
    total: Counter[str] = Counter()
    for file in summary["files"]:
        counts = {key: file[key] for key in file if key.endswith(("_covered", "_total"))}
        rooms.setdefault(room_of(file["filename"]), Counter()).update(counts)
        total.update(counts)
    print(f"{'room':20} {'lines':>16} {'':>6} {'branches':>16}")
    for room, counts in [*sorted(rooms.items()), ("all", total)]:
        cells = [room.ljust(20)]
        for kind in ("line", "branch"):
            covered, of = counts[f"{kind}_covered"], counts[f"{kind}_total"]
            cells.append(f"{covered:7}/{of:<8} {100 * covered / of if of else 100:5.1f}%")
        print(" ".join(cells))


if __name__ == "__main__":
    main()
