"""What flattening returns and keeps."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

import beltrami


def test_a_result_knows_all_about_itself(hump):
    vertices, faces = hump
    result = beltrami.parameterize(vertices, faces, coarse_faces=100)
    assert result.status == "BELTRAMI_OK"
    assert result.injective
    assert result.converged
    assert result.uv.shape == (len(vertices), 2)
    assert result.faces is faces
    assert result.certificate.positive == len(faces)
    assert result.certificate.first_bad_face is None
    assert 2 <= result.energy.symmetric_dirichlet < 2.2
    assert result.energy.max >= result.energy.symmetric_dirichlet
    assert [stage.name for stage in result.stages][:2] == ["simplify", "coarse"]
    assert result.report.faces == len(faces)
    assert result.report.first_degenerate_face is None
    assert result.options["coarse_faces"] == 100
    assert result.mesh is None
    assert "uv" not in repr(result)
    assert {result: 1}[result] == 1
    assert result != beltrami.parameterize(vertices, faces)


def test_the_type_of_the_uvs_is_that_of_the_vertices(hump):
    vertices, faces = hump
    types = {np.float16: np.float32, np.float32: np.float32, np.float64: np.float64}
    types[np.longdouble] = types[np.int64] = np.float64
    for given, returned in types.items():
        assert beltrami.parameterize((100 * vertices).astype(given), faces).uv.dtype == returned
    assert beltrami.parameterize(vertices, faces, float32=True).uv.dtype == np.float32


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_the_verdict_is_on_the_numbers_that_are_returned(bust, dtype):
    vertices, faces = bust
    result = beltrami.parameterize(vertices.astype(dtype), faces)
    assert result.certificate == beltrami.check_injective(result.uv, faces)


def test_vertices_without_faces_are_at_the_origin(hump):
    vertices, faces = hump
    more = np.concatenate([[[9.0, 9.0, 9.0]], vertices])
    result = beltrami.parameterize(more, faces + 1)
    assert result.report.unreferenced_vertices == 1
    assert result.uv[0].tolist() == [0, 0]
    assert result.uv[1:].tobytes() == beltrami.parameterize(vertices, faces).uv.tobytes()


def test_delaunay_faces_are_those_that_the_map_is_injective_on(bust):
    vertices, faces = bust
    result = beltrami.parameterize(vertices, faces.astype(np.int32), delaunay=True)
    assert result.report.delaunay_flips > 0
    assert result.faces.dtype == np.int32
    assert (result.faces != faces).any()
    assert beltrami.check_injective(result.uv, result.faces)


def test_a_map_that_is_not_injective_comes_with_a_warning_at_the_caller(bust):
    flattener = beltrami.Flattener(method="uv-prolongation")
    calls = [
        lambda: beltrami.parameterize(*bust, method="uv-prolongation"),
        lambda: flattener.parameterize(*bust),
    ]
    for call in calls:
        with pytest.warns(beltrami.NotInjectiveWarning, match="flipped faces") as caught:
            call()
        assert caught[0].filename == __file__
    with pytest.warns(beltrami.NotInjectiveWarning) as caught:
        result = flattener.run()
    assert caught[0].filename == __file__
    assert not result.injective
    assert result.status == "BELTRAMI_NOT_INJECTIVE"
    assert result.certificate.negative > 0
    assert not result.certificate


def test_an_iteration_limit_shows_in_the_status(bust):
    result = beltrami.parameterize(*bust, method="cm", max_iterations=1)
    assert result.status == "BELTRAMI_NOT_CONVERGED"
    assert result.injective
    assert not result.converged


def test_no_warning_without_reason(hump):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        beltrami.parameterize(*hump, progress=True)


# ---- Flattener ----------------------------------------------------------------------------


def test_a_flattener_keeps_its_mesh_and_options(hump):
    vertices, faces = hump
    flattener = beltrami.Flattener(energy="symmetric-arap")
    flattener.set_mesh(vertices, faces)
    first = flattener.run()
    assert first.uv.tobytes() == beltrami.parameterize(*hump, energy="symmetric-arap").uv.tobytes()
    with pytest.raises(beltrami.MeshError):
        flattener.set_mesh(vertices, faces + 1)
    assert flattener.run().uv.tobytes() == first.uv.tobytes()
    flattener.set_options(energy="symmetric-dirichlet")
    assert flattener.options["energy"] == "symmetric-dirichlet"
    assert flattener.run().uv.tobytes() == beltrami.parameterize(*hump).uv.tobytes()
    flattener.options["energy"] = "symmetric-arap"
    assert flattener.options["energy"] == "symmetric-dirichlet"


def test_a_flattener_without_a_mesh_says_so():
    with pytest.raises(beltrami.InvalidStateError, match="no mesh") as caught:
        beltrami.Flattener().run()
    assert caught.value.status == "BELTRAMI_E_INVALID_STATE"


def test_a_run_needs_no_more_memory_than_it_is_allowed(hump):
    flattener = beltrami.Flattener()
    with pytest.raises(beltrami.InvalidStateError, match="no mesh"):
        flattener.estimate_memory()
    flattener.set_mesh(*hump)
    needed = flattener.estimate_memory()
    flattener.set_options(memory_limit=needed - 1)
    with pytest.raises(MemoryError, match="memory-limit"):
        flattener.run()
    flattener.set_options(memory_limit=needed)
    assert flattener.run().injective


def test_a_refused_option_leaves_the_old_value(hump):
    flattener = beltrami.Flattener(threads=2)
    with pytest.raises(ValueError, match="threads"):
        flattener.set_options(threads=0)
    assert flattener.options["threads"] == 2
    assert flattener.parameterize(*hump).options["threads"] == 2


def test_options_are_kept_as_plain_values():
    flattener = beltrami.Flattener(
        threads=np.int8(2), tolerance=np.float32(0.5), refine=np.bool_(True), delaunay=True
    )
    kept = flattener.options
    found = [(type(kept[name]), kept[name]) for name in ("threads", "tolerance", "refine")]
    assert found == [(int, 2), (float, 0.5), (bool, True)]
    assert (kept["delaunay"], kept["method"]) == (True, "beltrami")


def test_results_do_not_change_with_later_runs(hump):
    vertices, faces = hump
    flattener = beltrami.Flattener()
    first = flattener.parameterize(vertices, faces)
    kept = first.uv.copy()
    flattener.parameterize(2 * vertices, faces)
    assert (first.uv == kept).all()


def test_the_arrays_are_free_after_set_mesh(hump):
    vertices, faces = hump
    flattener = beltrami.Flattener()
    given, given_faces = vertices.copy(), faces.copy()
    flattener.set_mesh(given, given_faces)
    given[:], given_faces[:] = np.nan, 0
    assert flattener.run().uv.tobytes() == beltrami.parameterize(vertices, faces).uv.tobytes()


def test_inputs_are_never_written_to(hump):
    vertices, faces = hump[0].copy(), hump[1].copy()
    beltrami.parameterize(vertices, faces, delaunay=True)
    assert (vertices == hump[0]).all()
    assert (faces == hump[1]).all()


# ---- trimesh ------------------------------------------------------------------------------


def test_a_trimesh_comes_back_with_its_uvs(hump):
    trimesh = pytest.importorskip("trimesh")
    mesh = trimesh.Trimesh(*hump, process=False, metadata={"name": "hump"})
    result = beltrami.parameterize(mesh)
    assert result.uv.tobytes() == beltrami.parameterize(*hump).uv.tobytes()
    assert result.mesh is not mesh
    assert (result.mesh.vertices == mesh.vertices).all()
    assert (result.mesh.faces == mesh.faces).all()
    assert (result.mesh.visual.uv == result.uv).all()
    assert result.mesh.metadata["name"] == "hump"
    assert mesh.visual.kind != "texture"
    assert beltrami.Flattener().parameterize(mesh).mesh is not None


def test_a_trimesh_gets_the_delaunay_faces(bust):
    trimesh = pytest.importorskip("trimesh")
    result = beltrami.parameterize(trimesh.Trimesh(*bust, process=False), delaunay=True)
    assert (result.mesh.faces == result.faces).all()
    assert beltrami.check_injective(result.mesh.visual.uv, result.mesh.faces)
