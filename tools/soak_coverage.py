"""Say which share of the lines the inputs of the fuzzers reach.

    soak_coverage.py BUILD OUT

BUILD is the folder of the preset fuzz-coverage. OUT has what ./dev soak has kept so far; the files
of fuzz/corpus are read as well. Writes OUT/coverage.md, and OUT/coverage.lcov with every line.
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
#: Folders of sources that read what others have written, and the share of lines to be reached.
GOALS = {"program/files": 95, "src/abi": 90}
MOST_FILES = 20
#: Inputs end a fuzzer that are slow in a build that counts; the next ones are run all the same.
RUN_SECONDS = 300


def folders_of(name: str, out: Path) -> list[Path]:
    """Return where the inputs of a fuzzer lie."""
    folders = [out / "corpus" / name, ROOT / "fuzz" / "corpus" / name]
    return [folder for folder in folders if folder.is_dir()]


def profile(program: Path, out: Path) -> Path:
    """Run all inputs of a fuzzer once; return what was counted."""
    name = program.name.removeprefix("fuzz_")
    raw = out / "profiles" / f"{name}.raw"
    raw.parent.mkdir(parents=True, exist_ok=True)
    command = [str(program), "-runs=0", f"-max_total_time={RUN_SECONDS}"]
    command += [str(folder) for folder in folders_of(name, out)]
    environment = {"LLVM_PROFILE_FILE": str(raw), "PATH": "/usr/bin:/bin"}
    subprocess.run(command, capture_output=True, check=False, cwd=out, env=environment)
    return raw


def counts_of(lcov: Path) -> Iterator[tuple[str, int, int]]:
    """Give of each file of the project its path, its lines, and those that were reached."""
    path, lines, reached = "", 0, 0
    for text in lcov.read_text().splitlines():
        key, _, value = text.partition(":")
        if key == "SF":
            path, lines, reached = value, 0, 0
        elif key == "DA":
            lines += 1
            reached += int(value.split(",")[1]) > 0
        elif text == "end_of_record" and path.startswith(f"{ROOT}/"):
            yield path.removeprefix(f"{ROOT}/"), lines, reached


def report(counts: list[tuple[str, int, int]]) -> str:
    """Return the shares of the rooms, and the files that lack most, as Markdown."""
    text = ["| room | lines | reached | goal |", "|---|--:|--:|--:|"]
    lacking = []
    for room, goal in GOALS.items():
        inside = [row for row in counts if row[0].startswith(f"{room}/")]
        lines, reached = (sum(row[column] for row in inside) for column in (1, 2))
        share = 100 * reached / max(lines, 1)
        text.append(f"| `{room}` | {lines:,} | {share:.1f}% | {goal}% |")
        lacking += [(row[1] - row[2], row[0]) for row in inside if row[1] > row[2]]
    text += ["", "Files with most lines that no input reaches:", ""]
    text += [f"- {path}: {lines}" for lines, path in sorted(lacking, reverse=True)[:MOST_FILES]]
    return "\n".join(text) + "\n"


def main() -> int:
    """Run every fuzzer's inputs, and write the report."""
    build, out = (Path(argument).resolve() for argument in sys.argv[1:])
    programs = sorted((build / "fuzz").glob("fuzz_*"))
    raws = []
    for program in programs:
        print(f"dev: soak: what {program.name} reaches", flush=True)
        raws.append(str(profile(program, out)))
    merged, lcov = out / "profiles" / "all", out / "coverage.lcov"
    subprocess.run(["llvm-profdata", "merge", "-o", str(merged), *raws], check=True)
    command = ["llvm-cov", "export", "-format=lcov", f"-instr-profile={merged}"]
    command += [str(next((build / "src").glob("libbeltrami.so.*.*")))]
    for program in programs:
        command += ["-object", str(program)]
    with lcov.open("wb") as file:
        subprocess.run(command, check=True, stdout=file, stderr=subprocess.DEVNULL)
    text = report(list(counts_of(lcov)))
    (out / "coverage.md").write_text(text)
    print(text, end="")
    return 0


if __name__ == "__main__":
    sys.exit(main())
