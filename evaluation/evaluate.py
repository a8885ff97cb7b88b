"""What the paper shows in its Section 4, shown about this implementation, as one page of figures.

    evaluate.py [--data FOLDER...] [--budget 40m] [--out FOLDER] [--scheduler ADDRESS]

Base meshes (disks, and closed meshes of genus 0, which are opened) are those of the folders, or
those that come with the project. Those on which composite majorization (CM) ends at a mean energy
of 2.5 or more are refined, their surface kept, to sizes spread evenly from 20,000 faces to 4
million: small ones first, as far as the budget goes. Every run is a process of its own on one
thread, and a line of OUT/runs.jsonl: another call goes on from there. OUT/index.html has the
figures, which are also files beside it.

Seconds are CPU seconds; only their ratios carry to another machine. With --scheduler the runs go to
a Dask scheduler whose workers see the same files and interpreters.
"""

from __future__ import annotations

import argparse
import contextlib
import datetime
import json
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from concurrent.futures import Executor, ThreadPoolExecutor
from pathlib import Path
from typing import Any

import evaluate_process
import records
from evaluate_data import LARGEST, Base, read_bases, sources_of
from evaluate_page import write_page
from evaluate_plan import DataSet, plan_of
from evaluate_runs import Book, Loop, Record, Setting, own_version
from evaluate_worker import energy_names

import beltrami

UNITS = {"s": 1, "m": 60, "h": 3600}
WORKER = Path(__file__).with_name("evaluate_worker.py")
BAR = 24  # characters


def seconds_of(text: str) -> float:
    """Return the seconds of a text such as 90s, 40m or 1.5h; raises ArgumentTypeError."""
    found = re.fullmatch(r"(\d+(?:\.\d+)?)([smh]?)", text)
    if not found:
        raise argparse.ArgumentTypeError(f"{text!r} is no time: give 90s, 40m or 2h")
    return float(found[1]) * UNITS[found[2] or "s"]


def options(given: list[str] | None = None) -> argparse.Namespace:
    """Return the arguments of the program."""
    parser = argparse.ArgumentParser(
        prog="./dev evaluate",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    add = parser.add_argument
    add("--data", type=Path, nargs="+", default=[], metavar="FOLDER", help="with base meshes")
    add(
        "--punctured",
        type=Path,
        nargs="+",
        default=[],
        metavar="FOLDER",
        help="with closed meshes, to be without a triangle; left out, those of --data",
    )
    add("--budget", type=seconds_of, default=seconds_of("40m"), help="time for runs: 90s, 40m, 2h")
    add("--out", type=Path, default=records.ROOT / "build" / "evaluation", metavar="FOLDER")
    add("--jobs", type=int, default=1, help="runs at a time; more than one blurs CPU seconds")
    add("--scheduler", metavar="ADDRESS", help="of a Dask scheduler, such as tcp://host:8786")
    add("--meshes", type=int, default=0, help="refined meshes; left out, three of each base")
    add("--largest", type=int, default=LARGEST, help="faces")
    add("--limit", type=seconds_of, default=900.0, help="CPU time of a run")
    add("--rivals-python", default=sys.executable, metavar="PYTHON", help="the one with Blender")
    add("--quiet", action="store_true", help="no progress")
    return parser.parse_args(given)


def versions_of(rivals_python: str) -> dict[str, str]:
    """Return the versions of all programs that are there."""
    found: dict[str, str] = {}
    for python in {sys.executable, rivals_python}:
        command = [python, "-B", str(WORKER), "versions"]
        answer = subprocess.run(command, capture_output=True, text=True, check=True)
        listed = json.loads(answer.stdout)
        wanted = ("Blender",) if python != sys.executable else tuple(listed)
        found.update({name: listed[name] for name in wanted if name in listed})
    return {"beltrami": own_version(records.ROOT), **found}


@contextlib.contextmanager
def executor_of(scheduler: str | None, jobs: int) -> Iterator[tuple[Executor, int]]:
    """Yield what does runs, and how many at a time."""
    if scheduler is None:
        with ThreadPoolExecutor(jobs) as pool:
            yield pool, jobs
        return
    import cloudpickle
    from distributed import Client

    cloudpickle.register_pickle_by_value(evaluate_process)  # workers have no such module
    with Client(scheduler) as client:
        slots = max(1, sum(client.nthreads().values()))
        yield client.get_executor(pure=False, retries=0), slots


def head() -> Record:
    """Return what all records of this session share."""
    described = subprocess.run(
        ["git", "-C", str(records.ROOT), "describe", "--always", "--dirty"],
        capture_output=True,
        text=True,
        check=False,
    )
    return {
        "date": datetime.datetime.now(datetime.timezone.utc).date().isoformat(),
        "commit": described.stdout.strip(),
        "processor": records.processor(),
        "build": beltrami.build_info(),
    }


def shower(quiet: bool) -> Any:
    """Return what shows the progress: a bar on a terminal, else a line now and then."""
    terminal = sys.stderr.isatty()

    def show(text: str, passed: float, left: float) -> None:
        share = passed / max(passed + left, 1e-9)
        bar = ("#" * round(share * BAR)).ljust(BAR, ".")
        width = shutil.get_terminal_size().columns - BAR - 24 if terminal else len(text)
        line = f"[{bar}] {share:4.0%}  {left / 60:4.0f} min left  {text[: max(width, 20)]}"
        shown = f"\r\x1b[K{line}" if terminal else f"{line}\n"
        print(shown, end="", file=sys.stderr, flush=True)

    return (lambda *_: None) if quiet else show


def bases_for(data: list[Path], punctured: list[Path]) -> tuple[list[Base], dict[str, str]]:
    """Return the base meshes of folders, and why other files give none."""
    bases, refused = read_bases(sources_of(data))
    if punctured or all(base.main for base in bases):  # other closed meshes to take a face of
        others, more = read_bases(sources_of(punctured))
        bases = [base for base in bases if base.main]
        bases += [base for base in others if not base.main]
        refused.update(more if punctured else {})
    return bases, refused


def main(given: list[str] | None = None) -> int:
    """Run the program."""
    arguments = options(given)
    bases, refused = bases_for(arguments.data, arguments.punctured)
    if not any(base.main for base in bases):
        print("evaluate: there is no disk or closed mesh in these folders", file=sys.stderr)
        return 2
    data = DataSet(bases, energy_names(), arguments.meshes, arguments.largest, refused=refused)
    book = Book(arguments.out / "runs.jsonl", versions_of(arguments.rivals_python))
    with executor_of(arguments.scheduler, arguments.jobs) as (executor, slots):
        setting = Setting(
            folder=arguments.out.resolve(),
            own=sys.executable,
            rivals=arguments.rivals_python,
            limit=arguments.limit,
            budget=arguments.budget,
            slots=slots,
            head=head(),
        )
        loop = Loop(lambda known: plan_of(data, known), book, setting, executor)
        try:
            loop.run(shower(arguments.quiet))
        except KeyboardInterrupt:
            print("\nevaluate: stopped; another call goes on from here", file=sys.stderr)
            return 130
    print(f"\n{write_page(data, book, arguments.out)}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
