"""Many meshes: resuming, failures, processes and workers that die."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import textwrap
from pathlib import Path

import numpy as np
import pytest
from conftest import grid, read_obj, write_obj

import beltrami
from beltrami import _jobs, _program


@pytest.fixture
def meshes(tmp_path):
    """Three good meshes and a closed one."""
    folder = tmp_path / "in"
    folder.mkdir()
    paths = [write_obj(folder / f"hump{n}.obj", *grid(n)) for n in (8, 9, 10)]
    tetrahedron = [[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]]
    return [*paths, write_obj(folder / "closed.obj", np.eye(4, 3), tetrahedron)]


def log_of(folder):
    return [json.loads(line) for line in (folder / "batch.jsonl").read_text().splitlines()]


def test_every_mesh_gets_its_result_or_its_failure(meshes, tmp_path):
    out = tmp_path / "out"
    records = beltrami.batch([*meshes, tmp_path / "missing.obj"], out)
    assert [record.input for record in records] == [
        *map(str, meshes),
        str(tmp_path / "missing.obj"),
    ]
    assert [record.ok for record in records] == [True, True, True, False, False]
    assert [record.injective for record in records[:3]] == [True, True, True]
    assert records[3].status == "BELTRAMI_E_CLOSED"
    assert "closed" in records[3].message
    assert records[4].status == "FILE_ERROR"
    for path, record in zip(meshes[:3], records):
        vertices, _, faces = read_obj(path)
        expected = beltrami.parameterize(vertices, faces).uv
        assert read_obj(out / record.output)[1].tobytes() == expected.tobytes()
        assert record.report["input"]["faces"] == len(faces)
    assert len(log_of(out)) == 5
    assert sorted(path.name for path in out.iterdir()) == [
        "batch.jsonl",
        "hump10.obj",
        "hump8.obj",
        "hump9.obj",
    ]


def test_a_second_call_does_nothing_again(meshes, tmp_path):
    first = beltrami.batch(meshes, tmp_path / "out")
    times = {path: path.stat().st_mtime_ns for path in (tmp_path / "out").iterdir()}
    second = beltrami.batch(meshes, tmp_path / "out", threads=2)
    assert all(record.resumed for record in second)
    assert not any(record.resumed for record in first)
    assert [r.report for r in second] == [r.report for r in first]
    assert {path: path.stat().st_mtime_ns for path in (tmp_path / "out").iterdir()} == times


def resumed(records):
    return [record.resumed for record in records]


def test_what_changed_is_done_again(meshes, tmp_path):
    out = tmp_path / "out"
    beltrami.batch(meshes, out)
    write_obj(meshes[1], *grid(11))
    assert resumed(beltrami.batch(meshes, out)) == [True, False, True, True]
    (out / "hump10.obj").unlink()
    assert resumed(beltrami.batch(meshes, out)) == [True, True, False, True]
    assert resumed(beltrami.batch(meshes, out, energy="symmetric-arap")) == [False] * 4
    assert resumed(beltrami.batch(meshes, out, energy="symmetric-arap")) == [True] * 4
    assert resumed(beltrami.batch(meshes, out)) == [False] * 4


def test_any_mesh_is_unwrapped(meshes, tmp_path):
    out = tmp_path / "atlases"
    records = beltrami.unwrap_batch(meshes, out, hard_angle=60)
    assert [record.injective for record in records] == [True] * 4
    closed = records[3].report
    assert closed["command"] == "unwrap"
    assert closed["admitted"]["closed_components"] == 1
    assert closed["options"]["hard-angle"] == 60
    again = beltrami.unwrap_batch(meshes, out, hard_angle=60, threads=2)
    assert resumed(again) == [True] * 4
    again = beltrami.unwrap_batch(meshes, out, hard_angle=60, triangulate=True)
    assert resumed(again) == [False] * 4
    assert resumed(beltrami.batch(meshes, out)) == [False] * 4


def test_an_atlas_is_written_in_the_format_of_its_mesh(tmp_path):
    trimesh = pytest.importorskip("trimesh")
    for suffix in ("ply", "glb", "stl"):
        trimesh.creation.box().export(tmp_path / f"{suffix}.{suffix}")
    paths = sorted(tmp_path.iterdir())
    records = beltrami.unwrap_batch(paths, tmp_path / "out")
    assert [record.output for record in records] == ["glb.glb", "ply.ply", "stl.obj"]
    assert [record.injective for record in records] == [True] * 3
    records = beltrami.unwrap_batch(paths, tmp_path / "out", suffix=".obj")
    assert [record.output for record in records] == ["glb.obj", "ply.obj", "stl.obj"]
    with pytest.raises(ValueError, match=r"give '\.obj' or '\.ply'"):
        beltrami.unwrap_batch(paths, tmp_path / "out", suffix=".stl")


def test_an_atlas_is_cut_along_the_materials_of_a_file(tmp_path):
    path = write_obj(tmp_path / "strip.obj", *grid(2))
    lines = path.read_text().splitlines()
    lines.insert(9 + 4, "usemtl stone")
    path.write_text("\n".join(lines) + "\n")
    plain, parted = (
        beltrami.unwrap_batch([path], tmp_path / f"out{labels}", labels=labels)[0]
        for labels in (None, "materials")
    )
    assert plain.report["charts"] == 1
    assert parted.report["charts"] > 1
    missing = beltrami.unwrap_batch([path], tmp_path / "outgroups", labels="groups")[0]
    assert not missing.ok
    assert "no groups" in missing.message


def test_a_new_version_does_all_again(meshes, tmp_path, monkeypatch):
    beltrami.batch(meshes, tmp_path / "out")
    monkeypatch.setattr(_jobs._library, "version", lambda: "9.9.9")
    assert resumed(beltrami.batch(meshes, tmp_path / "out")) == [False] * 4


@pytest.mark.parametrize("rest", [b'{"input": "/somewhere/hum', b"\xff\x00", b"[]\n7\n", b"\n\n"])
def test_a_log_that_was_cut_off_is_read_as_far_as_it_goes(meshes, tmp_path, rest):
    out = tmp_path / "out"
    beltrami.batch(meshes[:2], out)
    with (out / "batch.jsonl").open("ab") as log:
        log.write(rest)
    assert resumed(beltrami.batch(meshes, out)) == [True, True, False, False]
    assert resumed(beltrami.batch(meshes, out)) == [True] * 4


def test_names_that_collide_are_refused_before_any_work(tmp_path):
    paths = []
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
        paths.append(write_obj(tmp_path / name / "mesh.obj", *grid(4)))
    with pytest.raises(ValueError, match=r"both become mesh\.ply: name a root"):
        beltrami.batch(paths, tmp_path / "out", suffix=".ply")
    records = beltrami.batch(paths, tmp_path / "out", root=tmp_path, suffix=".ply")
    assert [record.output for record in records] == ["a/mesh.ply", "b/mesh.ply"]
    assert (tmp_path / "out" / "a" / "mesh.ply").read_bytes().startswith(b"ply")


def test_a_result_may_not_replace_a_mesh(meshes, tmp_path):
    before = [path.read_bytes() for path in meshes]
    (tmp_path / "link").symlink_to(meshes[0].parent)
    for folder in (meshes[0].parent, tmp_path / "link"):
        with pytest.raises(ValueError, match=r"hump8\.obj is a mesh of the batch: name another"):
            beltrami.batch(meshes, folder)
    assert [path.read_bytes() for path in meshes] == before
    assert beltrami.batch(meshes[:1], meshes[0].parent, suffix=".ply")[0].ok


def test_one_path_is_no_list(meshes, tmp_path):
    for path in (meshes[0], str(meshes[0])):
        with pytest.raises(TypeError, match="give a list of paths"):
            beltrami.batch(path, tmp_path / "out")


def test_what_could_not_be_written_is_a_failure_and_tried_again(meshes, tmp_path):
    out = tmp_path / "out"
    out.mkdir()
    (out / "in").write_text("no folder")
    records = beltrami.batch(meshes, out, root=tmp_path)
    assert [record.status for record in records] == ["FILE_ERROR"] * 4
    assert "in" in records[0].message
    (out / "in").unlink()
    (out / "in" / "hump8.obj").mkdir(parents=True)
    records = beltrami.batch(meshes, out, root=tmp_path)
    assert [record.ok for record in records] == [False, True, True, False]
    assert "cannot be written" in records[0].message
    (out / "in" / "hump8.obj").rmdir()
    records = beltrami.batch(meshes, out, root=tmp_path)
    assert [record.ok for record in records] == [True, True, True, False]
    assert resumed(records) == [False, True, True, True]


def test_another_mesh_of_the_same_name_size_and_time_is_done(tmp_path):
    paths = []
    for folder in ("one", "two"):
        (tmp_path / folder).mkdir()
        paths.append(write_obj(tmp_path / folder / "mesh.obj", *grid(4)))
        os.utime(paths[-1], (1, 1))
    for path in paths:
        records = beltrami.batch([path], tmp_path / "out")
        assert (records[0].input, records[0].resumed) == (str(path), False)


def test_numbers_of_numpy_are_options(meshes, tmp_path):
    options = {
        "coarse_faces": np.int64(60),
        "tolerance": np.float32(0.1),
        "refine": np.bool_(False),
    }
    record = beltrami.batch(meshes[:1], tmp_path / "out", **options)[0]
    vertices, _, faces = read_obj(meshes[0])
    expected = beltrami.parameterize(vertices, faces, **options).uv
    assert read_obj(tmp_path / "out" / record.output)[1].tobytes() == expected.tobytes()
    assert record.report["options"]["tolerance"] == float(np.float32(0.1))
    assert resumed(beltrami.batch(meshes[:1], tmp_path / "out", **options)) == [True]


def test_a_path_may_come_twice(meshes, tmp_path):
    records = beltrami.batch([meshes[0], meshes[0]], tmp_path / "out")
    assert records[0] == records[1]
    assert len(log_of(tmp_path / "out")) == 1


def test_options_are_checked_before_any_work(meshes, tmp_path):
    with pytest.raises(ValueError, match="energy is 'other'"):
        beltrami.batch(meshes, tmp_path / "out", energy="other")
    with pytest.raises(ValueError, match="suffix"):
        beltrami.batch(meshes, tmp_path / "out", suffix=".stl")
    assert not (tmp_path / "out").exists()


def test_no_meshes_are_no_work(tmp_path):
    assert beltrami.batch([], tmp_path / "out") == []


def test_progress_counts_meshes_and_cancels(meshes, tmp_path):
    seen = []
    beltrami.batch(meshes, tmp_path / "out", progress=lambda *args: seen.append(args))
    assert [fraction for fraction, _ in seen] == [0.25, 0.5, 0.75, 1]
    assert {path for _, path in seen} == set(map(str, meshes))
    with pytest.raises(beltrami.Cancelled):
        beltrami.batch(meshes, tmp_path / "two", jobs=1, progress=lambda *_: False)
    assert len(log_of(tmp_path / "two")) == 1
    assert sum(resumed(beltrami.batch(meshes, tmp_path / "two"))) == 1


def script(path, text):
    path.write_text(f"#!/bin/sh\n{text}\n")
    path.chmod(0o755)
    return path


def test_a_process_that_dies_takes_only_its_mesh(meshes, tmp_path, monkeypatch):
    program = _program.path()
    fake = script(
        tmp_path / "program",
        f'case $2 in *hump9*) kill -9 $$ ;; *hump10*) exit 77 ;; esac; exec {program} "$@"',
    )
    monkeypatch.setattr(_program, "path", lambda: fake)
    records = beltrami.batch(meshes, tmp_path / "out")
    assert [record.ok for record in records] == [True, False, False, False]
    assert [record.status for record in records[1:3]] == ["PROCESS_DIED"] * 2
    assert records[1].message == "the process ended with SIGKILL"
    assert records[2].message == "the process ended with exit code 77"
    monkeypatch.undo()
    again = beltrami.batch(meshes, tmp_path / "out")
    assert resumed(again) == [True, False, False, True]
    assert [record.ok for record in again] == [True, True, True, False]


def test_ctrl_c_ends_the_processes_and_another_call_resumes(meshes, tmp_path):
    program = textwrap.dedent("""
        import sys
        import beltrami
        from beltrami import _program
        from pathlib import Path
        _program.path = lambda: Path(sys.argv[1])
        try:
            beltrami.batch(sys.argv[3:], sys.argv[2], jobs=2)
        except KeyboardInterrupt:
            print("interrupted")
    """)
    log = tmp_path / "out" / "batch.jsonl"
    # The second mesh waits until the first is done, presses Ctrl-C, and goes on for ever.
    endless = f"until grep -q hump8 {log}; do sleep 0.01; done; kill -INT $PPID; exec sleep 100000"
    fake = script(
        tmp_path / "program",
        f'case $2 in *hump9*) {endless} ;; esac; exec {_program.path()} "$@"',
    )
    command = [sys.executable, "-B", "-c", program, fake, tmp_path / "out", *meshes[:2]]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert done.stdout == "interrupted\n"
    assert resumed(beltrami.batch(meshes[:2], tmp_path / "out")) == [True, False]


# ---- Dask ---------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def cluster():
    """Start a scheduler and two workers, each a process of its own."""
    distributed = pytest.importorskip("distributed")
    import dask

    config = {
        # A worker that dies with a job is enough to blame the job.
        "distributed.scheduler.allowed-failures": 0,
        # A busy machine may take its time.
        "distributed.comm.timeouts.connect": "600s",
        "distributed.comm.timeouts.tcp": "600s",
    }
    with (
        dask.config.set(config),
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, dashboard_address=None, silence_logs=50
        ) as local,
    ):
        yield local


dask_test = pytest.mark.filterwarnings("ignore")  # of its own dependencies


@dask_test
def test_a_dask_cluster_does_the_same(cluster, meshes, tmp_path):
    records = beltrami.batch(meshes, tmp_path / "dask", cluster.scheduler_address)
    local = beltrami.batch(meshes, tmp_path / "local")
    assert [record.status for record in records] == [record.status for record in local]
    for record in records[:3]:
        here, there = (tmp_path / name / record.output for name in ("local", "dask"))
        assert here.read_bytes() == there.read_bytes()
    again = beltrami.batch(meshes, tmp_path / "dask", cluster.scheduler_address)
    assert resumed(again) == [True] * 4
    atlases = beltrami.unwrap_batch(meshes, tmp_path / "atlases", cluster.scheduler_address)
    assert [record.injective for record in atlases] == [True] * 4


@dask_test
def test_a_worker_that_dies_takes_only_its_mesh(cluster, meshes, tmp_path):
    import distributed

    class FakeProgram(distributed.WorkerPlugin):
        """Runs another program in this worker, and in the one that takes its place."""

        def __init__(self, path):
            self.path = path

        def setup(self, worker):
            _program.path = lambda: Path(self.path)

        def teardown(self, worker):
            import importlib

            importlib.reload(_program)

    fake = script(
        tmp_path / "program",
        f'case $2 in *hump9*) kill -9 $PPID ;; esac; exec {_program.path()} "$@"',
    )
    with distributed.Client(cluster) as client:
        client.register_plugin(FakeProgram(str(fake)), name="fake")
        records = beltrami.batch(meshes, tmp_path / "out", client)
        client.unregister_worker_plugin("fake")
    assert [record.ok for record in records] == [True, False, True, False]
    assert records[1].status == "PROCESS_DIED"
    assert "KilledWorker" in records[1].message
    assert records[3].status == "BELTRAMI_E_CLOSED"
    assert resumed(beltrami.batch(meshes, tmp_path / "out")) == [True, False, True, True]


def test_the_folder_may_be_elsewhere_than_the_working_folder(meshes, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    records = beltrami.batch([Path(os.path.relpath(meshes[0]))], "results")
    assert records[0].ok
    assert (tmp_path / "results" / "hump8.obj").exists()
