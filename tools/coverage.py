"""Prints what the tests ran of each room: lines and branches, in a table.

    coverage.py COVERAGE.json

COVERAGE.json is what gcovr writes with --json. A line of a template counts once, by the one of its
instances that ran most of it.
"""

from __future__ import annotations

import json
import sys
from collections import Counter
from pathlib import Path
from typing import Any


def room_of(filename: str) -> str:
    """Return the folder of a source below the root, two deep at most."""
    return "/".join(Path(filename).parts[:-1][:2])


def counts_of(lines: list[dict[str, Any]]) -> Counter[str]:
    """Return the lines and branches of a file, and how many of them ran."""
    ran: dict[int, bool] = {}
    branches: dict[int, tuple[int, int]] = {}
    for line in lines:
        number = line["line_number"]
        ran[number] = ran.get(number, False) or line["count"] > 0
        taken = sum(branch["count"] > 0 for branch in line["branches"])
        found = (taken, len(line["branches"]))
        branches[number] = max(branches.get(number, (0, 0)), found)
    return Counter(
        line_covered=sum(ran.values()),
        line_total=len(ran),
        branch_covered=sum(taken for taken, _ in branches.values()),
        branch_total=sum(total for _, total in branches.values()),
    )


def main() -> None:
    """Print the table."""
    rooms: dict[str, Counter[str]] = {}
    total: Counter[str] = Counter()
    for file in json.loads(Path(sys.argv[1]).read_text())["files"]:
        counts = counts_of(file["lines"])
        rooms.setdefault(room_of(file["file"]), Counter()).update(counts)
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
