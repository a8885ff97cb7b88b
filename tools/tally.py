"""Counts what the tests of a run have found, and says it in the last line.

    tally.py FOLDER

FOLDER has stages.txt, a line a stage with its name and exit code, and for each stage NAME what its
tests have left: NAME.xml of CTest or pytest, NAME.*.xml of GoogleTest, and NAME.txt, the output of
cargo. A stage without tests counts as one. A process of CTest's that runs many cases is counted by
these, unless it has left no account of them.
"""

from __future__ import annotations

import re
import sys
import xml.etree.ElementTree as ElementTree
from collections import Counter
from pathlib import Path

CARGO = re.compile(r"^test result: .*?(\d+) passed; (\d+) failed; (\d+) ignored", re.M)


def outcome_of(case: ElementTree.Element) -> str:
    """Return what became of a test case."""
    if case.find("failure") is not None or case.find("error") is not None:
        return "failed"
    if case.find("skipped") is not None or case.get("result") == "skipped":
        return "skipped"
    return "disabled" if case.get("status") in ("notrun", "disabled") else "passed"


def count(file: Path, counted: set[str]) -> Counter[str]:
    """Return the numbers of an account, but for the processes that have accounts of their own."""
    if file.suffix == ".txt":
        found = CARGO.findall(file.read_text())
        return Counter(
            passed=sum(int(row[0]) for row in found),
            failed=sum(int(row[1]) for row in found),
            skipped=sum(int(row[2]) for row in found),
        )
    cases = ElementTree.parse(file).getroot().iter("testcase")
    return Counter(outcome_of(case) for case in cases if case.get("name") not in counted)


def main() -> int:
    """Print a line for each stage, and the sum."""
    folder = Path(sys.argv[1])
    total: Counter[str] = Counter()
    for line in (folder / "stages.txt").read_text().splitlines():
        name, code = line.rsplit(" ", 1)
        files = [f for f in folder.glob(f"{name}.*") if f.suffix in (".xml", ".txt")]
        counted = {f.stem.removeprefix(f"{name}.") for f in files}
        found: Counter[str] = Counter()
        for file in sorted(files):
            found += count(file, counted)
        if code != "0" and not found["failed"]:
            found["failed"] = 1
        elif not found:
            found["passed"] = 1
        print(f"dev: {name}: " + ", ".join(f"{number} {what}" for what, number in found.items()))
        total += found
    if total["skipped"]:
        print(f"dev: {total['skipped']} were skipped, for want of what they need")
    print(f"{total['passed']} passed, {total['failed']} failed")
    return 1 if total["failed"] else 0


if __name__ == "__main__":
    sys.exit(main())
