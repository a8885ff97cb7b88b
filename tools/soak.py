"""Run the fuzzers side by side, one for each processor, and report what they have done and found.

    soak.py BUILD OUT [--minutes N] [--data FOLDER] [--target NAME ...]

BUILD has the fuzzers of fuzz/CMakeLists.txt. OUT keeps a growing corpus of each, what they found,
and report.md. Each begins with the files of fuzz/corpus, and with small meshes of --data, of which
nothing is written. The exit code is 1 where something was found.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
DICTIONARIES = ROOT / "fuzz" / "dictionaries"
# Formats whose files may come from --data, and the fuzzers that read them.
SUFFIXES = {
    "obj": (".obj",),
    "off": (".off",),
    "ply": (".ply",),
    "stl": (".stl",),
    "gltf": (".gltf", ".glb"),
}
MOST_BYTES = 16384  # of a mesh that is worth mutating
# Seconds that one input may take: those of the library's own work are small meshes.
INPUT_SECONDS = 60
MEMORY_MIB = 3072
# Shapes of the generator that one turn makes, at most.
SHAPES = 1_000_000
# Their sizes are held down: what takes long is found with few bytes or not at all.
MOST_INPUT = {
    "bake": 1024,
    "exact": 256,
    "library": 1024,
    "pack": 256,
    "program": 2048,
    "search": 256,
    "surfaces": 1024,
    "unwrap_file": 1024,
}


@dataclass
class Turn:
    """What one fuzzer did."""

    name: str
    executions: int = 0
    edges: int = 0
    corpus: int = 0
    seconds: float = 0
    findings: list[str] = field(default_factory=list)
    slowest: list[tuple[int, float]] = field(default_factory=list)


def seeds_of_data(name: str, folder: Path | None, into: Path) -> None:
    """Copy the small meshes of a format into a folder of seeds."""
    into.mkdir(parents=True, exist_ok=True)
    if folder is None or name not in SUFFIXES:
        return
    for file in sorted(folder.rglob("*")):
        is_mesh = file.suffix.lower() in SUFFIXES[name] and file.is_file()
        if is_mesh and file.stat().st_size <= MOST_BYTES:
            shutil.copyfile(file, into / file.name)


def run_fuzzer(program: Path, seconds: int, out: Path, data: Path | None) -> Turn:
    """Run one fuzzer, again and again where it finds something, until its time is over."""
    name = program.name.removeprefix("fuzz_")
    corpus, found = out / "corpus" / name, out / "findings" / name
    seeds = out / "seeds" / name
    for folder in (corpus, found):
        folder.mkdir(parents=True, exist_ok=True)
    seeds_of_data(name, data, seeds)
    turn = Turn(name)
    began = time.monotonic()
    command = [
        str(program),
        str(corpus),
        str(seeds),
        f"-max_total_time={seconds}",
        f"-timeout={INPUT_SECONDS}",
        f"-rss_limit_mb={MEMORY_MIB}",
        f"-artifact_prefix={found}/",
        "-print_final_stats=1",
        "-print_funcs=0",
        f"-max_len={MOST_INPUT.get(name, 4096)}",
        "-reload=0",
        "-report_slow_units=1000000",
    ]
    own = ROOT / "fuzz" / "corpus" / name
    if own.is_dir():
        command.insert(3, str(own))
    dictionary = DICTIONARIES / f"{name}.dict"
    if dictionary.exists():
        command.append(f"-dict={dictionary}")
    # Several lines of stderr a second, over hours: to a file.
    log = out / "logs" / f"{name}.txt"
    log.parent.mkdir(parents=True, exist_ok=True)
    before = set(found.iterdir())
    with log.open("wb") as file:
        subprocess.run(command, stdout=file, stderr=file, check=False, cwd=out)
    turn.seconds = time.monotonic() - began
    read_log(log.read_text(errors="replace"), turn)
    turn.corpus = len(list(corpus.iterdir()))
    turn.findings += [str(f.relative_to(out)) for f in sorted(set(found.iterdir()) - before)]
    return turn


def read_log(text: str, turn: Turn) -> None:
    """Take the figures of a fuzzer from what it printed."""
    done = re.findall(r"^stat::number_of_executed_units:\s*(\d+)", text, re.M)
    if not done:
        done = re.findall(r"^#(\d+)\s", text, re.M)[-1:]
    turn.executions = int(done[-1]) if done else 0
    turn.edges = max((int(n) for n in re.findall(r"\bcov: (\d+)", text)), default=0)
    slow = re.findall(r"^slowest below (\d+) bytes: ([0-9.]+) CPU s", text, re.M)
    turn.slowest = [(int(size), float(seconds)) for size, seconds in slow]
    turn.findings += re.findall(r"^BROKEN: (.*)", text, re.M)
    turn.findings += re.findall(r"^(?:SUMMARY|ERROR): (.*)", text, re.M)


def run_shapes(program: Path, seconds: int, out: Path, seed: int) -> Turn:
    """Have the generator make shapes of the tests until its time is over."""
    turn = Turn("shapes")
    found = out / "findings" / "shapes"
    log = out / "logs" / "shapes.txt"
    log.parent.mkdir(parents=True, exist_ok=True)
    began = time.monotonic()
    command = [str(program), "--seed", str(seed), "--count", str(SHAPES), "--out", str(found)]
    command += ["--seconds", str(seconds), "--again"]
    with log.open("wb") as file:
        status = subprocess.run(command, stdout=file, stderr=file, check=False).returncode
    turn.seconds = time.monotonic() - began
    text = log.read_text(errors="replace")
    rows = text.split("checks that failed, by kind and option")[-1]
    turn.executions = sum(int(n) for n in re.findall(r"^\S+ +(\d+) checks", rows, re.M))
    if status:
        turn.findings = re.findall(r"^(?!slow)(\w+ +\w+ +\d+ \w+ .*)", text, re.M) or ["it failed"]
    return turn


def run_faults(program: Path, seconds: int, out: Path, seed: int) -> Turn:
    """Disturb whole runs of the program until its time is over."""
    turn = Turn("faults")
    command = [sys.executable, "-B", str(ROOT / "tools" / "soak_faults.py"), str(program)]
    command += ["--seconds", str(seconds), "--seed", str(seed)]
    began = time.monotonic()
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=out)
    turn.seconds = time.monotonic() - began
    rounds = re.findall(r"^(\d+) rounds", done.stdout, re.M)
    turn.executions = int(rounds[-1]) if rounds else 0
    turn.findings = re.findall(r"^BROKEN: (.*)", done.stdout, re.M)
    if done.returncode and not turn.findings:
        turn.findings = [done.stderr.strip().splitlines()[-1]]
    return turn


def row(turn: Turn) -> str:
    """Return a line of the table of the report."""
    slow = max(turn.slowest, key=lambda pair: pair[1], default=None)
    slowest = f"{slow[1]:.3f} s below {slow[0]} bytes" if slow else ""
    cells = [turn.name, f"{turn.seconds:.0f}", f"{turn.executions:,}", str(turn.edges or "")]
    cells += [str(turn.corpus or ""), str(len(turn.findings)), slowest]
    return "| " + " | ".join(cells) + " |"


def report(turns: list[Turn]) -> str:
    """Return the report as Markdown."""
    lines = ["# Soak", "", "| run | s | executions | edges | corpus | findings | slowest, CPU |"]
    lines += ["|---|--:|--:|--:|--:|--:|---|"] + [row(turn) for turn in turns]
    total = sum(turn.executions for turn in turns)
    lines += ["", f"{total:,} executions."]
    for turn in turns:
        if turn.findings:
            lines += ["", f"## {turn.name}", ""] + [f"- {finding}" for finding in turn.findings]
    lines += ["", "## Slowest inputs, by size", ""]
    for turn in turns:
        sizes = ", ".join(f"{seconds:.3f} s below {size} B" for size, seconds in turn.slowest)
        if sizes:
            lines.append(f"- {turn.name}: {sizes}")
    return "\n".join(lines) + "\n"


def main() -> int:
    """Run all in turns, and write the report."""
    parser = argparse.ArgumentParser(description="Fuzz everything in turns.", prog="./dev soak")
    parser.add_argument("build", type=Path, help=argparse.SUPPRESS)
    parser.add_argument("out", type=Path, help=argparse.SUPPRESS)
    parser.add_argument("--minutes", type=float, default=30, help="of all runs together [30]")
    parser.add_argument("--data", type=Path, help="a folder whose small meshes are read as well")
    parser.add_argument("--target", action="append", help="only this run, or these")
    parser.add_argument("--shapes", type=Path, help=argparse.SUPPRESS)
    parser.add_argument("--program", type=Path, help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    programs = sorted(arguments.build.glob("fuzz_*"))
    names = [program.name.removeprefix("fuzz_") for program in programs]
    if arguments.shapes:
        names.append("shapes")
    if arguments.program:
        names.append("faults")
    wanted = arguments.target or names
    for name in wanted:
        if name not in names:
            parser.error(f"there is no run '{name}': {', '.join(names)}")
    jobs = min(len(wanted), os.cpu_count() or 1)
    seconds = max(1, int(60 * arguments.minutes * jobs / len(wanted)))
    out = arguments.out.resolve()
    out.mkdir(parents=True, exist_ok=True)
    data = arguments.data.resolve() if arguments.data else None

    def run(name: str) -> Turn:
        print(f"dev: soak: {name} for {seconds} s", flush=True)
        if name == "shapes":
            return run_shapes(arguments.shapes, seconds, out, int(time.time()))
        if name == "faults":
            return run_faults(arguments.program.resolve(), seconds, out, int(time.time()))
        return run_fuzzer(arguments.build.resolve() / f"fuzz_{name}", seconds, out, data)

    with ThreadPoolExecutor(jobs) as pool:  # each run is a process
        turns = list(pool.map(run, wanted))
    text = report(turns)
    (out / "report.md").write_text(text)
    print(text, end="")
    print(f"dev: {out / 'report.md'}")
    return 1 if any(turn.findings for turn in turns) else 0


if __name__ == "__main__":
    sys.exit(main())
