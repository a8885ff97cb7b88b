"""Refuses links of pages that lead nowhere within the project: files, and headings of pages.

links.py PAGE ...
"""

from __future__ import annotations

import re
import sys
from functools import cache
from pathlib import Path

LINK = re.compile(r"\[(?:[^\[\]]|\[[^\]]*\])*\]\(([^)\s]+)\)")


@cache
def anchors(page: Path) -> set[str]:
    """Return what the headings of a page are called in links."""
    found: set[str] = set()
    text = re.sub(r"^```.*?^```", "", page.read_text(), flags=re.S | re.M)
    for heading in re.findall(r"^#+ (.*)$", text, re.M):
        plain = re.sub(r"\[([^\]]*)\]\([^)]*\)|`", r"\1", heading).lower()
        found.add(re.sub(r"[^\w\- ]", "", plain).strip().replace(" ", "-"))
    return found | set(re.findall(r'<a (?:id|name)="([^"]+)"', text))


def problems(page: Path) -> list[str]:
    """Return a line for each link of a page that leads nowhere."""
    wrong = []
    text = re.sub(
        r"^```.*?^```", lambda m: re.sub(r"[^\n]", "", m[0]), page.read_text(), flags=re.S | re.M
    )
    for number, line in enumerate(re.sub(r"`[^`\n]*`", "", text).splitlines(), 1):
        for target in LINK.findall(line):
            if re.match(r"[a-z]+:", target):
                continue
            path, _, anchor = target.partition("#")
            there = (page.parent / path).resolve() if path else page.resolve()
            if not there.exists():
                wrong.append(f"{page}:{number}: there is no {target}")
            elif anchor and there.suffix == ".md" and anchor not in anchors(there):
                wrong.append(f"{page}:{number}: {path or page.name} has no heading #{anchor}")
    return wrong


def main() -> int:
    """Look at the pages that the arguments name."""
    wrong = [line for name in sys.argv[1:] for line in problems(Path(name))]
    print("\n".join(wrong), file=sys.stderr, end="\n" if wrong else "")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
