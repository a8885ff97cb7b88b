"""What ./dev evaluate builds its data set from, how it resumes, and what it makes of records."""

from __future__ import annotations

import json
import subprocess
import sys
from concurrent.futures import Executor, Future
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("matplotlib")
from conftest import ROOT, grid, write_obj
from evaluate import bases_for, executor_of, options
from evaluate_data import (
    LEAST_ENERGY,
    Base,
    Mesh,
    bases_of,
    body,
    boundary_edges,
    digest_of,
    ladder,
    make,
    read_bases,
    sizes,
)
from evaluate_plan import DataSet, base_run, plan_of, run_of
from evaluate_process import STOPPED, execute
from evaluate_runs import Book, Clock, Loop, Run, Setting, own_version
from meshes import areas, edges, is_sphere, refine

import beltrami

VERSIONS = {"beltrami": "v1", "SLIM": "libigl 1"}


# ---- The data set -------------------------------------------------------------------------


@pytest.mark.parametrize("target", [150, 288, 700, 1152, 2000])
def test_refinement_keeps_the_surface_and_its_boundary_and_meets_the_size(target):
    vertices, faces = grid(6)
    fine, corners = refine(vertices, faces, target, smooth=False)
    assert abs(len(corners) - target) <= max(2, target // 100)
    assert areas(fine, corners).sum() == pytest.approx(areas(vertices, faces).sum(), rel=1e-12)
    assert np.array_equal(fine[: len(vertices)], vertices)
    assert len(fine) - len(edges(corners)[0]) + len(corners) == 1
    assert beltrami.parameterize(fine, corners, method="tutte").injective


def test_sizes_are_spread_evenly_from_the_smallest_to_the_largest():
    found = sizes(25)
    assert (found[0], found[-1]) == (20_000, 4_000_000)
    steps = np.diff(np.log(found))
    assert steps.max() - steps.min() < 1e-3


def test_all_bases_take_turns_on_the_ladder_and_none_is_coarsened():
    bases = [base(name, 10_000) for name in "abcd"] + [base("large", 500_000)]
    meshes = ladder(bases, 20)
    assert [mesh.faces for mesh in meshes] == sorted(mesh.faces for mesh in meshes)
    assert all(mesh.faces >= 470_000 for mesh in meshes if mesh.name == "large")
    names = [mesh.name for mesh in meshes]
    assert {names.count(name) for name in "abcd"} <= {3, 4, 5}
    assert ladder(bases, 20) == meshes


def test_bases_are_kept_from_the_papers_energy_on():
    bases = [base(name, 10_000) for name in ("flat", "round", "refused")]
    data = DataSet(bases, ["symmetric-dirichlet"])
    book = Book(None, VERSIONS)
    book.add("bases", base_run(bases[0]), map_of(LEAST_ENERGY - 1e-9), {})
    book.add("bases", base_run(bases[1]), map_of(LEAST_ENERGY), {})
    assert data.kept(book) is None
    assert list(plan_of(data, book)) == ["bases"]
    book.add("bases", base_run(bases[2]), {"status": "BELTRAMI_E_HANDLES", "wall": 1.0}, {})
    assert data.kept(book) == [bases[1]]
    assert {mesh.name for mesh in data.ladder(book)} == {"round"}


def test_a_closed_mesh_gives_disks_along_seams_and_one_without_a_face(tmp_path):
    vertices, faces = body(1, 500)
    assert is_sphere(vertices, faces)
    found = list(bases_of(str(write_obj(tmp_path / "closed.obj", vertices, faces))))
    assert [base.main for base in found] == [False, True, True]
    punctured, opened = make(found[0].mesh), make(found[1].mesh)
    assert boundary_edges(punctured[1]) == 3
    assert len(punctured[1]) == len(faces) - 1
    assert boundary_edges(opened[1]) > 3
    for made in (punctured, opened):
        assert areas(*made).sum() == pytest.approx(1)
        assert beltrami.parameterize(*made, method="tutte").injective


def test_what_is_no_base_mesh_is_named_with_the_reason(tmp_path):
    vertices, faces = grid(4)
    write_obj(tmp_path / "disk.obj", vertices, faces)
    write_obj(tmp_path / "holes.obj", vertices, np.delete(faces, [9, 10], axis=0))
    (tmp_path / "quads.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n")
    found, refused = read_bases(str(path) for path in sorted(tmp_path.iterdir()))
    assert [base.mesh.name for base in found] == ["disk"]
    assert set(refused) == {"holes.obj", "quads.obj"}
    assert "neither a disk nor closed" in refused["holes.obj"]


def test_bodies_are_the_same_at_every_call():
    for first, second in zip(body(3, 700), body(3, 700)):
        assert np.array_equal(first, second)


# ---- Runs ---------------------------------------------------------------------------------


class Immediately(Executor):
    """Does what is submitted at once, and remembers it."""

    def __init__(self, does):
        self.does = does
        self.tasks = []

    def submit(self, _function, task):
        self.tasks.append(task)
        future = Future()
        future.set_result(self.does(task))
        return future


def loop_of(runs, book, does, budget=100.0):
    executor = Immediately(does)
    setting = Setting(Path("folder"), "python", "python", limit=60, budget=budget)
    loop = Loop(lambda _: {"main": (1.0, runs)}, book, setting, executor)
    loop.run(lambda *_: None)
    return executor.tasks


def test_what_is_recorded_is_not_run_again(tmp_path):
    path = tmp_path / "runs.jsonl"
    runs = [run_of(mesh("a", 20_000), mode) for mode in ("ours", "cm", "gif")]
    done = loop_of(runs[:2], Book(path, VERSIONS), lambda _: map_of(3))
    assert len(done) == 2
    path.write_text(path.read_text() + '{"schema": 1, "key": "cut o')  # by a kill
    assert [
        task["options"] for task in loop_of(runs, Book(path, VERSIONS), lambda _: map_of(3))
    ] == [{"flatten": "gif"}]
    newer = Book(path, {**VERSIONS, "beltrami": "v2"})
    assert len(loop_of(runs, newer, lambda _: map_of(3))) == 3


def test_runs_that_do_not_fit_the_budget_are_not_begun():
    book = Book(None, VERSIONS)
    small, large = run_of(mesh("a", 20_000), "cm"), run_of(mesh("a", 4_000_000), "cm")
    tasks = loop_of([large, small], book, lambda _: map_of(3), budget=20)
    assert [task["mesh"]["faces"] for task in tasks] == [20_000]
    assert loop_of([small], Book(None, VERSIONS), lambda _: map_of(3), budget=0) == []


def test_a_run_that_the_budget_stopped_is_not_recorded():
    book = Book(None, VERSIONS)
    runs = [run_of(mesh("a", 20_000), "cm")]
    assert len(loop_of(runs, book, lambda _: {"status": STOPPED, "wall": 1.0})) == 1
    assert book.records == {}


def test_the_budget_is_shared_out_between_the_experiments():
    book = Book(None, VERSIONS)
    plan = {
        "main": (0.75, [run_of(mesh("a", n), "cm") for n in range(20_000, 20_040)]),
        "rivals": (0.25, [run_of(mesh("b", n), "cm") for n in range(20_000, 20_040)]),
    }
    executor = Immediately(lambda _: map_of(3))
    setting = Setting(Path("folder"), "python", "python", limit=60, budget=3600)
    loop = Loop(lambda _: plan, book, setting, executor)
    loop.run(lambda *_: None)
    first = [task["mesh"]["name"] for task in executor.tasks[:20]]
    assert 14 <= first.count("a") <= 16


def test_what_runs_take_is_learnt_from_records():
    clock = Clock()
    run = run_of(mesh("a", 100_000), "cm")
    before = clock.seconds(run)
    for _ in range(5):
        clock.learn({"mode": "cm", "faces": 100_000, "wall": 3 * before})
    assert clock.seconds(run) == pytest.approx(3 * before)
    assert clock.seconds(run_of(mesh("a", 10_000), "cm")) < clock.seconds(run)


def test_a_run_in_a_process_has_all_that_a_record_has(tmp_path):
    vertices, faces = grid(12, height=2)
    source = str(write_obj(tmp_path / "hump.obj", vertices, faces))
    disk = Mesh("hump", source, digest_of(source), faces=600)
    book = Book(tmp_path / "runs.jsonl", VERSIONS)
    run = Run(disk, "ours", 600, keep=True)
    found = execute(setting(tmp_path).task(run, 300))
    record = book.add("main", run, found, {"commit": "c"})
    assert record["status"] == "BELTRAMI_OK"
    assert record["certified"]
    assert record["injective"]
    assert record["flips"] == record["crossings"] == 0
    assert set(record["histograms"]) <= set(record["energies"])
    assert list(record["energies"])[:2] == ["symmetric-dirichlet", "symmetric-arap"]
    assert record["energies"]["symmetric-dirichlet"] >= 2
    for shares in record["histograms"].values():
        assert sum(shares) == pytest.approx(1, abs=1e-6)
    assert record["boundary"] == boundary_edges(make(disk)[1])
    assert {"coarse", "certify"} <= set(record["stages"])
    assert record["cpu_seconds"] >= 0
    assert record["peak_bytes"] > 1e6
    assert Book(tmp_path / "runs.jsonl", VERSIONS).find(run) == json.loads(json.dumps(record))
    with np.load(tmp_path / "uvs" / run.uv_name()) as kept:
        assert kept["uv"].shape == (len(make(disk)[0]), 2)


def test_a_run_that_fails_crashes_or_takes_too_long_says_so(tmp_path, monkeypatch):
    vertices, faces = grid(4)
    source = str(write_obj(tmp_path / "holes.obj", vertices, np.delete(faces, [9, 10], axis=0)))
    run = Run(Mesh("holes", source, digest_of(source)), "ours", 30)
    task = setting(tmp_path).task(run, 300)
    assert execute(task)["status"].startswith("BELTRAMI_E_")
    assert execute({**task, "wall": 0.0})["status"] == STOPPED
    worker = tmp_path / "worker.py"
    codes = {
        "import os; os.abort()": "CRASHED",
        "import os, signal; os.kill(os.getpid(), signal.SIGXCPU)": "TIMEOUT",
    }
    for code, status in codes.items():
        worker.write_text(code)
        assert execute({**task, "worker": str(worker)})["status"] == status


@pytest.mark.filterwarnings("ignore")  # of Dask's own dependencies
def test_a_dask_scheduler_does_runs_without_knowing_these_modules(tmp_path):
    distributed = pytest.importorskip("distributed")
    vertices, faces = grid(6)
    source = str(write_obj(tmp_path / "hump.obj", vertices, faces))
    run = Run(Mesh("hump", source, digest_of(source)), "ours", 72)
    with (
        distributed.LocalCluster(
            n_workers=1, threads_per_worker=2, dashboard_address=None, silence_logs=50
        ) as cluster,
        executor_of(cluster.scheduler_address, 1) as (executor, slots),
    ):
        assert slots == 2
        found = executor.submit(execute, setting(tmp_path).task(run, 300)).result(timeout=120)
    assert found["status"] == "BELTRAMI_OK"


def test_the_version_is_that_of_the_sources(tmp_path):
    for room in ("include", "src"):
        (tmp_path / room).mkdir()
        (tmp_path / room / "a.h").write_text("int a;\n")
    before = own_version(tmp_path)
    (tmp_path / "README.md").write_text("text")
    assert own_version(tmp_path) == before
    (tmp_path / "src" / "a.h").write_text("int b;\n")
    assert own_version(tmp_path) != before


# ---- Arguments ---------------------------------------------------------------------------------


def test_a_budget_is_a_number_with_a_unit():
    assert [options(["--budget", text]).budget for text in ("90s", "40m", "1.5h", "7")] == [
        90,
        2400,
        5400,
        7,
    ]
    with pytest.raises(SystemExit):
        options(["--budget", "soon"])


def test_disks_are_of_one_folder_and_closed_meshes_of_another(tmp_path):
    disks, closed = tmp_path / "disks", tmp_path / "closed"
    for folder in (disks, closed):
        folder.mkdir()
    write_obj(disks / "disk.obj", *grid(4))
    write_obj(closed / "ball.obj", *body(1, 200))
    bases, refused = bases_for([disks], [closed])
    assert [base.mesh.name for base in bases] == ["disk", "ball punctured"]
    assert refused == {}
    alone, _ = bases_for([closed], [])
    assert [base.mesh.name for base in alone] == ["ball punctured", "ball cut 2", "ball cut 3"]
    shipped, _ = bases_for([disks], [])
    assert {"disk", "spot punctured"} <= {base.mesh.name for base in shipped}


def test_the_help_of_dev_names_it():
    shown = subprocess.run([ROOT / "dev", "help"], capture_output=True, text=True, check=True)
    assert "\n  evaluate" in shown.stdout


# ---- Support ------------------------------------------------------------------------------


def mesh(name: str, faces: int) -> Mesh:
    return Mesh(name, f"{name}.obj", name, faces=faces)


def base(name: str, faces: int) -> Base:
    return Base(mesh(name, 0), faces, main=True)


def setting(folder: Path) -> Setting:
    return Setting(folder, sys.executable, sys.executable, limit=60, budget=300)


def map_of(energy: float) -> dict[str, object]:
    return {
        "status": "BELTRAMI_OK",
        "energies": {"symmetric-dirichlet": energy, "symmetric-arap": energy - 2},
        "wall": 1.0,
    }
