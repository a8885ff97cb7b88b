"""The runs of ./dev evaluate: what each is, what is recorded of it, and the loop that does them.

A record is a line of JSON. A run is told from others by the mesh (by contents), the program, its
options and its version, ours being a hash of the sources: what is recorded is not run again.
"""

from __future__ import annotations

import hashlib
import json
import statistics
import time
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from evaluate_data import Mesh
from evaluate_process import STOPPED, execute

SCHEMA = 1
# Wall seconds of a run: those of any, and those for 100,000 faces, which grow a little faster than
# the faces. Records of a session correct them by their median.
OVERHEAD = 1.5
COSTS = {"ours": 0.8, "cm": 3.0, "refine": 1.5, "plain gif": 1.0, "uv prolongation": 0.4}
COSTS.update({"SLIM": 20.0, "SCAF": 35.0, "Blender": 35.0})
GROWTH = 1.15
FEW = 5  # records of a program before its own median counts


@dataclass(frozen=True)
class Run:
    """One program on one mesh."""

    mesh: Mesh
    mode: str  # its name in figures
    faces: int  # about what the mesh has
    options: tuple[tuple[str, object], ...] = ()
    program: str = "beltrami"
    keep: bool = False  # the UVs, for a picture

    def key(self, version: str) -> str:
        """Return what its record is found by."""
        options = dict(sorted(self.options))
        return json.dumps([self.mesh.key(), self.program, options, self.keep, version])

    def uv_name(self) -> str:
        """Return the name of the file for its UVs."""
        return hashlib.sha256(self.key("").encode()).hexdigest()[:16] + ".npz"


Record = dict[str, Any]


def own_version(root: Path) -> str:
    """Return a hash of the sources of the library, whatever else has changed since."""
    files = sorted(path for room in ("include", "src") for path in (root / room).rglob("*.*"))
    digest = hashlib.sha256()
    for path in files:
        digest.update(str(path.relative_to(root)).encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()[:12]


class Book:
    """The records in a file, found by run; each is written as soon as it is known."""

    def __init__(self, path: Path | None, versions: Mapping[str, str]):
        self._path = path
        self._versions = versions
        self.records: dict[str, Record] = {}
        if path is not None and path.exists():
            for line in path.read_text().splitlines():
                record = _record_of(line)
                if record is not None:
                    self.records[record["key"]] = record

    def find(self, run: Run) -> Record | None:
        """Return the record of a run."""
        return self.records.get(run.key(self._versions[run.program]))

    def knows(self, program: str) -> bool:
        """Return whether there is such a program here."""
        return program in self._versions

    def add(self, experiment: str, run: Run, found: Mapping[str, Any], head: Record) -> Record:
        """Record what came of a run, and return that."""
        version = self._versions[run.program]
        record = {
            "schema": SCHEMA,
            "key": run.key(version),
            "experiment": experiment,
            "mesh": run.mesh.name,
            "digest": run.mesh.digest,
            "faces": run.faces,
            "mode": run.mode,
            "program": run.program,
            "version": version,
            "options": dict(run.options),
            **head,
            **found,
        }
        self.records[record["key"]] = record
        if self._path is not None:
            self._path.parent.mkdir(parents=True, exist_ok=True)
            with self._path.open("a") as file:
                file.write(json.dumps(record) + "\n")
        return record


def _record_of(line: str) -> Record | None:
    """Return a record; None of a line left unfinished, or of another schema."""
    try:
        record = json.loads(line)
    except json.JSONDecodeError:
        return None
    return record if isinstance(record, dict) and record.get("schema") == SCHEMA else None


def succeeded(record: Record | None) -> bool:
    """Return whether there is a map, whatever it is like."""
    return record is not None and "energies" in record


class Clock:
    """What runs take, learnt from those that were done."""

    def __init__(self, records: Iterable[Record] = ()) -> None:
        self._ratios: dict[str, list[float]] = {}
        for record in records:
            self.learn(record)

    def learn(self, record: Record) -> None:
        """Take in what a run took."""
        if "wall" in record:
            ratio = record["wall"] / self._first_guess(record["mode"], record["faces"])
            self._ratios.setdefault(family(record["mode"]), []).append(ratio)

    def seconds(self, run: Run) -> float:
        """Return the wall seconds that a run is expected to take."""
        own = self._ratios.get(family(run.mode), [])
        if len(own) < FEW:
            own = [ratio for ratios in self._ratios.values() for ratio in ratios] or [1.0]
        return self._first_guess(run.mode, run.faces) * statistics.median(own)

    def _first_guess(self, mode: str, faces: int) -> float:
        return float(OVERHEAD + COSTS.get(family(mode), 1.0) * (faces / 1e5) ** GROWTH)


def family(mode: str) -> str:
    """Return the mode whose cost another has."""
    if mode.startswith("cm"):
        return "cm"
    return mode if mode in COSTS else "ours"


@dataclass(frozen=True)
class Setting:
    """Where runs happen, and within what."""

    folder: Path  # for meshes and UVs
    own: str  # the interpreter that has our package
    rivals: str  # the one that has Blender's
    limit: float  # CPU seconds of a run
    budget: float  # wall seconds of all
    slots: int = 1  # runs at a time
    head: Record = field(default_factory=dict)  # commit, processor and so on

    def task(self, run: Run, wall: float) -> dict[str, Any]:
        """Return what evaluate_process.execute takes."""
        mesh = hashlib.sha256(run.mesh.key().encode()).hexdigest()[:16]
        return {
            "own": self.own,
            "python": self.rivals if run.program == "Blender" else self.own,
            "worker": str(Path(__file__).with_name("evaluate_worker.py")),
            "mesh": run.mesh.flat(),
            "made": str(self.folder / "meshes" / f"{mesh}.npz"),
            "program": run.program,
            "options": dict(run.options),
            "limit": self.limit,
            "wall": wall,
            "keep": run.keep,
            "uv": str(self.folder / "uvs" / run.uv_name()),
        }


# Returns, for each experiment by name, its share of the budget and its runs in order: also those
# that are recorded, and as far as records tell which come next.
Plan = Callable[[Book], Mapping[str, tuple[float, Iterable[Run]]]]


class Loop:
    """Does runs until all are recorded, or none fits into the budget any more."""

    def __init__(self, plan: Plan, book: Book, setting: Setting, executor: Executor):
        self._plan, self._book, self._setting, self._executor = plan, book, setting, executor
        self._clock = Clock(book.records.values())
        self._start = time.monotonic()
        self._spent: dict[str, float] = {}  # by experiment
        for record in book.records.values():
            self._count(record)
        self._flying: dict[Future[dict[str, Any]], tuple[str, Run]] = {}
        self._stopped: set[Run] = set()

    def _count(self, record: Record) -> None:
        spent = self._spent.get(record["experiment"], 0.0)
        self._spent[record["experiment"]] = spent + record.get("wall", 0.0)

    def remaining(self) -> float:
        """Return the seconds that are left of the budget."""
        return self._setting.budget - (time.monotonic() - self._start)

    def pending(self) -> dict[str, list[Run]]:
        """Return the runs that are known to be missing, by experiment."""
        flying = {run for _, run in self._flying.values()} | self._stopped
        missing: dict[str, list[Run]] = {}
        for name, (_, runs) in self._plan(self._book).items():
            left = [run for run in runs if self._book.find(run) is None and run not in flying]
            missing[name] = left
        return missing

    def next(self, pending: Mapping[str, list[Run]]) -> tuple[str, Run] | None:
        """Return the first run that fits, of the experiment that has had least of its share."""
        shares = {name: share for name, (share, _) in self._plan(self._book).items()}
        order = sorted(shares, key=lambda name: self._spent.get(name, 0.0) / shares[name])
        for name in order:
            for run in pending[name]:
                if self._clock.seconds(run) <= self.remaining():
                    return name, run
        return None

    def left(self, pending: Mapping[str, list[Run]]) -> float:
        """Return the seconds that it will still take."""
        runs = [run for runs in pending.values() for run in runs]
        runs += [run for _, run in self._flying.values()]
        seconds = sum(self._clock.seconds(run) for run in runs) / self._setting.slots
        return max(0.0, min(self.remaining(), seconds))

    def run(self, show: Callable[[str, float, float], None]) -> None:
        """Do the runs; `show` is told the last one, the seconds that passed and those left."""
        while True:
            pending = self.pending()
            while len(self._flying) < self._setting.slots:
                chosen = self.next(pending)
                if chosen is None:
                    break
                self._submit(*chosen)
                pending = self.pending()
            if not self._flying:
                return
            done, _ = wait(self._flying, return_when=FIRST_COMPLETED)
            for future in done:
                text = self._take(future)
                show(text, time.monotonic() - self._start, self.left(self.pending()))

    def _submit(self, experiment: str, run: Run) -> None:
        task = self._setting.task(run, max(1.0, self.remaining()))
        self._flying[self._executor.submit(execute, task)] = (experiment, run)

    def _take(self, future: Future[dict[str, Any]]) -> str:
        experiment, run = self._flying.pop(future)
        try:
            found = future.result()
        except Exception as error:  # of a worker of the scheduler that died
            found = {"status": "CRASHED", "error": repr(error)[:300], "wall": 0.0}
        if found["status"] == STOPPED:
            self._stopped.add(run)
            return f"{run.mesh.name}, {run.mode}: stopped with the budget"
        record = self._book.add(experiment, run, found, self._setting.head)
        self._count(record)
        self._clock.learn(record)
        return f"{run.mesh.name}, {run.faces} faces, {run.mode}: {record['status']}"
