#!/usr/bin/env python3
"""What the build and the rings of tests lean on: groups of sources, and the count of what has failed.

tools_test.py ROOT
"""

from __future__ import annotations

import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(sys.argv[1]).resolve()
sys.path.insert(0, str(ROOT / "cmake"))
import groups  # noqa: E402

HELPER = "namespace {{\nint {}() {{ return 1; }}\n}}\n"


def parted(folder: pathlib.Path, sources: dict[str, str], kept: list[list[str]]) -> list[list[str]]:
    """Return the groups of sources given by their text, by their names below the folder."""
    for name, text in sources.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(text)
    names = [str(folder / name) for name in sources]
    before = [[str(folder / name) for name in group] for group in kept]
    found = groups.groups_to_compile(names, before)
    return [[str(pathlib.Path(name).relative_to(folder)) for name in group] for group in found]


def test_groups(folder: pathlib.Path) -> None:
    """Sources of a room stay together, but for names in conflict; what was together stays so."""
    sources = {
        "a/one.cpp": HELPER.format("first"),
        "a/two.cpp": HELPER.format("second"),
        "b/three.cpp": HELPER.format("third"),
        "b/four.cpp": HELPER.format("fourth"),
    }
    rooms = [["a/one.cpp", "a/two.cpp"], ["b/three.cpp", "b/four.cpp"]]
    assert parted(folder, sources, []) == rooms
    # The helper of another source of its room: it goes where it may.
    sources["a/two.cpp"] = HELPER.format("first")
    apart = [["a/one.cpp"], ["b/three.cpp", "b/four.cpp", "a/two.cpp"]]
    assert parted(folder, sources, rooms) == apart
    # Without the conflict what is compiled stays as it is.
    sources["a/two.cpp"] = HELPER.format("second")
    assert parted(folder, sources, apart) == apart
    # A large one waits for none.
    sources["a/one.cpp"] += "// a line\n" * groups.MOST_LINES
    assert ["a/one.cpp"] in parted(folder, sources, [])


def case(name: str, inside: str = "") -> str:
    """Return a test case as CTest and GoogleTest write it."""
    return f'<testcase name="{name}" status="run">{inside}</testcase>'


def tally(folder: pathlib.Path, files: dict[str, str]) -> tuple[int, str]:
    """Return the exit code and the last line for what stages have left."""
    folder.mkdir()
    for name, text in files.items():
        (folder / name).write_text(text)
    done = subprocess.run(
        [sys.executable, "-B", ROOT / "tools" / "tally.py", folder], capture_output=True, text=True
    )
    return done.returncode, done.stdout.splitlines()[-1]


def test_tally(folder: pathlib.Path) -> None:
    """Cases are counted, not the processes that they run in; but a process that dies counts."""
    cases = case("one") + case("two") + case("three", "<skipped/>")
    ran, died = case("Shard.a.0"), case("Shard.a.1", "<failure/>")
    files = {
        "stages.txt": "cpp 0\nrust 0\nlinters 0\n",
        "cpp.xml": f"<testsuite>{case('Gate')}{ran}</testsuite>",
        "cpp.Shard.a.0.xml": f"<testsuites><testsuite>{cases}</testsuite></testsuites>",
        "rust.txt": "test result: ok. 4 passed; 0 failed; 1 ignored; 0 measured\n",
    }
    assert tally(folder / "passed", files) == (0, "8 passed, 0 failed")
    files["cpp.xml"] = f"<testsuite>{case('Gate')}{ran}{died}</testsuite>"
    assert tally(folder / "died", files) == (1, "8 passed, 1 failed")
    # A stage that ends before its tests, and linters that find something.
    del files["cpp.xml"], files["cpp.Shard.a.0.xml"]
    files["stages.txt"] = "cpp 1\nrust 0\nlinters 1\n"
    assert tally(folder / "broken", files) == (1, "4 passed, 2 failed")


def main() -> None:
    """Run what is above, each in a folder of its own."""
    for test in (test_groups, test_tally):
        with tempfile.TemporaryDirectory() as folder:
            test(pathlib.Path(folder).resolve())


if __name__ == "__main__":
    main()
