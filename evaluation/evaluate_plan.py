"""What ./dev evaluate runs: the experiments of the paper's Section 4, and those beyond it.

Each is a function from the data set and the book of records to the runs that are known to belong to
it, in order. Some runs are known only when others are recorded: so a plan is asked for again and
again, and a session that is stopped goes on where it was.
"""

from __future__ import annotations

import functools
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from evaluate_data import LEAST_ENERGY, Base, Mesh, ladder
from evaluate_runs import Book, Record, Run, succeeded

Options = tuple[tuple[str, object], ...]

# Names of modes in figures, with their options.
MODES: dict[str, Options] = {
    "ours": (),
    "cm": (("method", "cm"),),
    "gif": (("flatten", "gif"),),
    "plain gif": (("method", "gif"),),
    "uv prolongation": (("method", "uv-prolongation"),),
    "flim": (("flatten", "flim"),),
    "dirichlet": (("flatten", "dirichlet"),),
    "refine": (("refine", True),),
}
# Of the largest meshes only what the paper's headline is about.
HEADLINE = ("ours", "gif", "cm")
ENERGY_MODES = ("ours", "gif", "cm")
COARSE_FACES = (200, 500, 1_000, 2_000, 5_000, 10_000, 20_000)
RIVALS = ("SLIM", "SCAF", "Blender")
ROUNDS = 3  # turns of each base on the ladder
FEWEST = 24  # meshes on the ladder
LARGE = (500_000, 1_000_000, 2_000_000, 4_000_000)
SUBSET = 8  # meshes of the experiments that need no more
EQUAL_FACES = 300_000  # at most, for the search for equal energy
COARSE_FROM = 90_000  # of fewer faces 20,000 are no coarse mesh
COARSE_MESHES = 5
TEXTURE_FACES = 60_000
# A map with less energy than CM's is not reached by it; equal up to this counts as reached.
EQUAL = 1e-6


@dataclass(frozen=True)
class DataSet:
    """What the experiments are about."""

    bases: Sequence[Base]
    energies: Sequence[str]  # that can be minimised, the default first
    count: int = 0  # meshes on the ladder; 0 chooses
    largest: int = LARGE[-1]
    rivals: Sequence[str] = RIVALS
    refused: Mapping[str, str] = field(default_factory=dict)

    def main(self) -> list[Base]:
        """Return the base meshes of the data set, kept or not."""
        return [base for base in self.bases if base.main]

    def kept(self, book: Book) -> list[Base] | None:
        """Return those whose energy is large enough, None while that is not known of all."""
        records = [book.find(base_run(base)) for base in self.main()]
        if any(record is None for record in records):
            return None
        return [base for base, record in zip(self.main(), records) if base_energy(record) >= 0]

    def ladder(self, book: Book) -> list[Mesh]:
        """Return the refined meshes, ascending; none while the bases are not known."""
        kept = self.kept(book)
        if not kept:
            return []
        count = self.count or max(FEWEST, ROUNDS * len(kept))
        return [mesh for mesh in _ladder(tuple(kept), count) if mesh.faces <= self.largest]


@functools.lru_cache(maxsize=4)
def _ladder(bases: tuple[Base, ...], count: int) -> list[Mesh]:
    return ladder(bases, count)


def base_energy(record: Record | None) -> float:
    """Return by how much a base is above the paper's cut; negative where it is left out."""
    if record is None or not succeeded(record):
        return -1.0
    return float(record["energies"]["symmetric-dirichlet"]) - LEAST_ENERGY


def base_run(base: Base) -> Run:
    """Return the run that decides about a base."""
    return Run(base.mesh, "cm", base.faces, MODES["cm"])


def run_of(mesh: Mesh, mode: str, more: Options = (), name: str = "", keep: bool = False) -> Run:
    """Return a run of ours on a refined mesh; `name` is for figures."""
    return Run(mesh, name or mode, mesh.faces, MODES[mode] + more, keep=keep)


def base_runs(data: DataSet, _book: Book) -> Iterator[Run]:
    """Yield CM on every base: its energy decides what is kept."""
    for base in data.main():
        yield base_run(base)


def main_runs(data: DataSet, book: Book) -> Iterator[Run]:
    """Yield every mode on the ladder."""
    for mesh in data.ladder(book):
        for mode in MODES:
            yield run_of(mesh, mode)
        yield from crossing_runs(mesh, book)
        yield from in_our_time(mesh, book)


def crossing_runs(mesh: Mesh, book: Book) -> Iterator[Run]:
    """Yield the comparison of equals where CM's map overlaps: both with that, both without."""
    found = book.find(run_of(mesh, "cm"))
    if found is not None and succeeded(found) and found["crossings"]:
        yield run_of(mesh, "ours", (("injectivity", "local"),), "ours, local")
        yield run_of(mesh, "cm", (("injectivity", "global"),), "cm, global")


def in_our_time(mesh: Mesh, book: Book) -> Iterator[Run]:
    """Yield CM stopped when ours had ended: the limit is in wall seconds, at the speed CM had."""
    ours, found = book.find(run_of(mesh, "ours")), book.find(run_of(mesh, "cm"))
    if ours is None or found is None or not (succeeded(ours) and succeeded(found)):
        return
    speed = found["seconds"] / max(found["cpu_seconds"], 1e-3)
    limit = float(f"{max(ours['cpu_seconds'] * speed, 1e-3):.3g}")
    if limit < found["seconds"]:
        yield run_of(mesh, "cm", (("time_limit", limit),), "cm in our time")


def large_runs(data: DataSet, book: Book) -> Iterator[Run]:
    """Yield what the paper's headline is about, on meshes of millions of faces."""
    kept = sorted(data.kept(book) or [], key=lambda base: base_energy(book.find(base_run(base))))
    middle = kept[len(kept) // 2 :] + kept[: len(kept) // 2]  # no easy one, and no hard one
    for size in LARGE:
        if size > data.largest:
            return
        for base in middle[: 1 if size > LARGE[0] else 2]:
            mesh = Mesh(**{**base.mesh.flat(), "faces": size})
            for mode in HEADLINE:
                yield run_of(mesh, mode)


def spread(meshes: Sequence[Mesh], count: int, most: int) -> list[Mesh]:
    """Return meshes of at most so many faces, each of another base, the smallest of them first."""
    chosen: dict[str, Mesh] = {}
    for mesh in meshes:
        if mesh.faces <= most and len(chosen) < count:
            chosen.setdefault(mesh.digest, mesh)
    return list(chosen.values())


def evenly(meshes: Sequence[Mesh], count: int, most: int) -> list[Mesh]:
    """Return about so many meshes of at most so many faces, of all sizes up to that."""
    small = [mesh for mesh in meshes if mesh.faces <= most]
    return small[:: max(1, len(small) // count)]


def equal_energy_runs(data: DataSet, book: Book) -> Iterator[Run]:
    """Yield CM with ever fewer iterations, until the number is known at which it has our energy."""
    for mesh in evenly(data.ladder(book), SUBSET, EQUAL_FACES):
        ours, found = book.find(run_of(mesh, "ours")), book.find(run_of(mesh, "cm"))
        if not (succeeded(ours) and succeeded(found)) or ours is None or found is None:
            continue
        yield from bisection(mesh, energy(ours), found, book)


def bisection(mesh: Mesh, target: float, found: Record, book: Book) -> Iterator[Run]:
    """Yield the runs of a search for the fewest iterations of CM that reach an energy."""
    reached, missed = iterations(found), 0
    if energy(found) > target * (1 + EQUAL):
        return
    step = 2
    while reached - missed > 1:
        probe = (reached + missed) // 2
        if missed == 0:  # the energy is reached in the last iterations
            probe = max(reached - step, probe)
        run = stopped(mesh, probe)
        yield run
        record = book.find(run)
        if record is None or not succeeded(record):
            return
        if energy(record) <= target * (1 + EQUAL):
            reached, step = probe, 2 * step
        else:
            missed = probe


def stopped(mesh: Mesh, count: int) -> Run:
    """Return CM with so many iterations at most."""
    return run_of(mesh, "cm", (("max_iterations", count),), f"cm at {count}")


def iterations(record: Record) -> int:
    """Return how many iterations a run of CM took."""
    return int(record["stages"].get("cm", [0, 0])[1])


def energy(record: Record) -> float:
    """Return the energy of a map that its run minimised."""
    name = record["options"].get("energy", "symmetric-dirichlet")
    return float(record["energies"].get(name, float("nan")))


def energy_runs(data: DataSet, book: Book) -> Iterator[Run]:
    """Yield the other energies than the default."""
    meshes = spread(data.ladder(book), 2 * SUBSET, 150_000)
    for mesh in meshes:
        for name in data.energies[1:]:
            for mode in ENERGY_MODES:
                yield run_of(mesh, mode, (("energy", name),))


def punctured_runs(data: DataSet, _book: Book) -> Iterator[Run]:
    """Yield closed meshes without one triangle, as they are."""
    for base in data.bases:
        if not base.main:
            for mode in ("ours", "gif", "plain gif", "cm"):
                yield Run(base.mesh, mode, base.faces, MODES[mode])


def simplify_runs(data: DataSet, book: Book) -> Iterator[Run]:
    """Yield ever fewer coarse faces, in the paper's own mode and in the default one."""
    meshes = [mesh for mesh in data.ladder(book) if mesh.faces >= COARSE_FROM]
    for mesh in spread(meshes, COARSE_MESHES, 2 * COARSE_FROM):
        for count in COARSE_FACES:
            for mode in ("gif", "ours"):
                yield run_of(mesh, mode, (("coarse_faces", count),))


def rival_runs(data: DataSet, book: Book) -> Iterator[Run]:
    """Yield the programs of others on the smallest meshes."""
    for mesh in spread(data.ladder(book), SUBSET, 60_000):
        yield run_of(mesh, "ours")
        for program in data.rivals:
            if book.knows(program):
                yield Run(mesh, program, mesh.faces, program=program)


def picture_runs(data: DataSet, book: Book) -> Iterator[Run]:
    """Yield the maps that pictures show: where UV prolongation flips most."""

    def flips(mesh: Mesh) -> int:
        record = book.find(run_of(mesh, "uv prolongation"))
        return record["flips"] if record is not None and succeeded(record) else -1

    meshes = [mesh for mesh in data.ladder(book) if mesh.faces <= TEXTURE_FACES]
    for mesh in sorted(meshes, key=flips, reverse=True)[:1]:
        for mode in ("ours", "uv prolongation"):
            yield run_of(mesh, mode, keep=True)


def plan_of(data: DataSet, book: Book) -> dict[str, tuple[float, Iterable[Run]]]:
    """Return all experiments by name, with their shares of the budget and their runs."""
    if data.kept(book) is None:
        return {"bases": (1.0, base_runs(data, book))}
    return {
        "bases": (1.0, base_runs(data, book)),
        "main": (0.46, main_runs(data, book)),
        "pictures": (0.02, picture_runs(data, book)),
        "large": (0.16, large_runs(data, book)),
        "equal energy": (0.08, equal_energy_runs(data, book)),
        "energies": (0.08, energy_runs(data, book)),
        "punctured": (0.05, punctured_runs(data, book)),
        "simplification": (0.07, simplify_runs(data, book)),
        "rivals": (0.08, rival_runs(data, book)),
    }
