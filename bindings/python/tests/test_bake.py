"""Images for new UVs."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import beltrami

SQUARE = np.array([[[0, 0], [1, 0], [1, 1]], [[0, 0], [1, 1], [0, 1]]], float)
PLACES = np.pad(SQUARE, ((0, 0), (0, 0), (0, 1)))


def noise(dtype: Any, channels: int, side: int = 32) -> np.ndarray:
    values = np.random.default_rng(1).random((side, side, channels))
    if dtype is np.float32:
        return values.astype(dtype)
    return (values * np.iinfo(dtype).max).astype(dtype)


def quarter(uvs: np.ndarray) -> np.ndarray:
    return np.stack([1 - uvs[..., 1], uvs[..., 0]], -1)


def smooth(side: int) -> np.ndarray:
    x = (np.arange(side) + 0.5) / side * 2 * np.pi
    image = 128 + 60 * np.sin(x)[:, None] + 60 * np.cos(x)
    return image.astype(np.uint8)


def psnr(a: np.ndarray, b: np.ndarray) -> float:
    error = np.mean((a.astype(float) - b) ** 2)
    return float(10 * np.log10(255**2 / max(error, 1e-9)))


@pytest.mark.parametrize("pixels", ["linear", "srgb", "srgb-alpha"])
@pytest.mark.parametrize("channels", [1, 2, 3, 4])
@pytest.mark.parametrize("dtype", [np.uint8, np.uint16, np.float32])
def test_the_same_uvs_give_the_same_image(dtype: Any, channels: int, pixels: Any) -> None:
    image = noise(dtype, channels)
    baked = beltrami.bake(image, SQUARE, SQUARE, resolution=32, pixels=pixels)
    assert baked.images.dtype == image.dtype
    assert (baked.texels, baked.without_source) == (1024, 0)
    assert baked.old_texels == pytest.approx(1)
    if dtype is np.float32:
        np.testing.assert_allclose(baked.images[0], image, atol=2e-6)
    else:
        np.testing.assert_array_equal(baked.images[0], image)


def test_a_quarter_turn_turns_the_image() -> None:
    image = noise(np.uint8, 3)
    baked = beltrami.bake(image, SQUARE, quarter(SQUARE), resolution=32)
    np.testing.assert_array_equal(baked.images[0], np.rot90(image))


@pytest.mark.parametrize("pixels", ["linear", "srgb", "srgb-alpha", "normals"])
def test_constants_stay(pixels: Any) -> None:
    image = np.full((16, 16, 4), [128, 128, 255, 90], np.uint8)
    turned = 0.5 + 0.3 * (quarter(SQUARE) - 0.5)
    baked = beltrami.bake(image, SQUARE, turned, resolution=64, pixels=pixels, vertices=PLACES)
    expected = np.broadcast_to(image[0, 0], baked.images.shape).astype(int)
    # The middle of 0 and 255 is between two bytes.
    assert np.abs(baked.images - expected).max() <= (1 if pixels == "normals" else 0)


def test_any_number_of_threads_gives_the_same_bits() -> None:
    def baked(threads: int) -> np.ndarray:
        return beltrami.bake(
            noise(np.uint8, 4), 3 * SQUARE, quarter(SQUARE), resolution=200, threads=threads
        ).images

    np.testing.assert_array_equal(baked(1), baked(2))


def test_a_smooth_image_is_kept_at_equal_density() -> None:
    shifted = 0.99 * SQUARE + [0.004, 0.003]
    there = beltrami.bake(smooth(256), SQUARE, shifted, resolution=256).images[0]
    back = beltrami.bake(there, shifted, SQUARE, resolution=256).images[0]
    assert psnr(back, smooth(256)) >= 40


@pytest.mark.parametrize("wrap", ["repeat", "mirror", "clamp"])
def test_what_is_beyond_the_image(wrap: Any) -> None:
    image = noise(np.uint8, 1, 16)[..., 0]
    baked = beltrami.bake(image, 2 * SQUARE, SQUARE, resolution=32, wrap=wrap).images[0]
    np.testing.assert_array_equal(baked[16:, :16], image)
    beside = {
        "repeat": image,
        "mirror": image[:, ::-1],
        "clamp": np.broadcast_to(image[:, -1:], (16, 16)),
    }
    np.testing.assert_array_equal(baked[16:, 16:], beside[wrap])


def test_pages_have_images_of_their_own() -> None:
    images = [np.full((8, 8), 10, np.uint8), np.full((4, 4), 20, np.uint8)]
    baked = beltrami.bake(
        images,
        SQUARE,
        SQUARE,
        resolution=8,
        gutter=0,
        old_pages=[0, 1],
        new_pages=[1, 0],
        masks=True,
    )
    assert baked.images.shape == (2, 8, 8)
    assert set(baked.images[0].ravel().tolist()) == {0, 20}
    assert set(baked.images[1].ravel().tolist()) == {0, 10}
    assert baked.masks is not None
    np.testing.assert_array_equal(baked.masks == 2, baked.images > 0)


def test_gutters_continue_what_they_are_beside() -> None:
    small = 0.25 + 0.5 * SQUARE
    image = np.full((8, 8), 77, np.uint8)
    rings = beltrami.bake(image, SQUARE, small, resolution=32, gutter=3, masks=True)
    assert rings.masks is not None
    assert (rings.images > 0).sum() == 22 * 22
    assert (rings.masks == 1).sum() == 22 * 22 - 16 * 16
    assert (beltrami.bake(image, SQUARE, small, resolution=32).images == 77).all()


def test_mirrored_halves_show_one_half() -> None:
    mirrored = SQUARE.copy()
    mirrored[..., 0] = 1 - mirrored[..., 0]
    old = np.concatenate([SQUARE, mirrored])
    new = np.concatenate([SQUARE * [0.5, 1], SQUARE * [0.5, 1] + [0.5, 0]])
    image = smooth(64)
    baked = beltrami.bake(image, old, new, resolution=64).images[0].astype(int)
    assert np.abs(baked - baked[:, ::-1]).max() <= 1


def test_normals_turn_with_their_chart() -> None:
    image = np.full((8, 8, 3), [200, 128, 220], np.uint8)
    baked = beltrami.bake(
        image, SQUARE, quarter(SQUARE), resolution=8, pixels="normals", vertices=PLACES
    ).images[0]
    # What tilted along the old u is along the new v.
    assert np.abs(baked.astype(int) - [127, 200, 220]).max() <= 1


def test_another_surface_of_the_same_shape() -> None:
    image = smooth(64)
    other = np.array([[[0, 0], [1, 0], [0, 1]], [[1, 0], [1, 1], [0, 1]]], float)
    places = np.pad(other, ((0, 0), (0, 0), (0, 1)))
    baked = beltrami.bake(
        image, SQUARE, other, resolution=64, vertices=places, source_vertices=PLACES
    )
    assert np.abs(baked.images[0].astype(int) - image).max() <= 1
    with pytest.raises(beltrami.InvalidArgumentError, match="texels have no source"):
        beltrami.bake(
            image,
            SQUARE,
            other,
            resolution=64,
            vertices=places + np.array([0, 0, 5]),
            source_vertices=PLACES,
        )


def test_texels_without_a_source_are_counted() -> None:
    old = SQUARE.copy()
    old[0] = np.nan
    baked = beltrami.bake(np.ones((4, 4), np.uint8), old, SQUARE, resolution=16, gutter=0)
    assert 0 < baked.without_source < baked.texels / 2
    assert (baked.images == 0).sum() == baked.without_source
    with pytest.raises(beltrami.InvalidArgumentError, match="no source"):
        beltrami.bake(np.ones((4, 4), np.uint8), old * np.nan, SQUARE, resolution=16)


def test_progress_ends_it() -> None:
    with pytest.raises(beltrami.Cancelled):
        beltrami.bake(noise(np.uint8, 3), SQUARE, SQUARE, resolution=512, progress=lambda *_: False)


@pytest.mark.parametrize(
    ("changed", "error", "words"),
    [
        ({"images": np.zeros((4, 4), np.int32)}, TypeError, "uint8, uint16 or float32"),
        ({"images": np.zeros((4, 4, 5), np.uint8)}, ValueError, "channels"),
        ({"images": []}, ValueError, "no image"),
        ({"old_uvs": SQUARE[:1]}, ValueError, "shape"),
        ({"new_uvs": SQUARE[0]}, ValueError, "shape"),
        ({"new_uvs": SQUARE * np.nan}, beltrami.NonFiniteError, "corner"),
        ({"pixels": "rgb"}, ValueError, "choose from"),
        ({"resolution": 0}, ValueError, "resolution"),
        ({"gutter": -1}, ValueError, "gutter"),
        ({"old_pages": [0, 1]}, beltrami.InvalidArgumentError, "counted from 0"),
        (
            {"pixels": "normals", "vertices": PLACES},
            beltrami.InvalidArgumentError,
            "3 or 4 channels",
        ),
        ({"pixels": "normals"}, TypeError, "vertices are missing"),
        ({"images": np.zeros((0, 4), np.uint8)}, ValueError, "no texels"),
        ({"new_uvs": SQUARE + np.array([1.5, 0])}, ValueError, "triangle 0 lie beyond its page"),
        ({"threads": 0}, ValueError, "threads"),
    ],
)
def test_what_is_wrong_is_said(changed: dict[str, Any], error: Any, words: str) -> None:
    given: dict[str, Any] = {
        "images": np.zeros((4, 4), np.uint8),
        "old_uvs": SQUARE,
        "new_uvs": SQUARE,
        "resolution": 16,
    }
    with pytest.raises(error, match=words):
        beltrami.bake(**{**given, **changed})


def floor_and_wall() -> tuple[np.ndarray, np.ndarray]:
    """Return the unit square, and the same with a wall of height 0.5 along x = 0."""
    wall = np.array([[0, -500, 0], [0, 500, 0], [0, 500, 0.5], [0, -500, 0.5]], float)
    return PLACES, np.concatenate([PLACES, wall[[[0, 1, 2], [0, 2, 3]]]])


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16, np.float32])
def test_a_wall_hides_half_of_the_sky_by_its_sine(dtype: Any) -> None:
    floor, walled = floor_and_wall()
    baked = beltrami.bake(
        np.zeros((1, 1), dtype),
        None,
        SQUARE,
        pixels="occlusion",
        vertices=floor,
        source_vertices=walled,
        rays=1024,
        resolution=32,
    )
    x = (np.arange(32) + 0.5) / 32
    most = 1 if dtype is np.float32 else np.iinfo(dtype).max
    wanted = (1 + x / np.sqrt(x * x + 0.25)) / 2
    assert baked.images.dtype == dtype
    np.testing.assert_allclose(baked.images[0] / most, np.tile(wanted, (32, 1)), atol=0.015)


def test_a_cage_sees_what_is_too_far_for_the_nearest_place() -> None:
    image = noise(np.uint8, 3)
    above = PLACES + np.array([0, 0, 0.3])
    given: Any = {"vertices": PLACES, "source_vertices": above, "resolution": 32}
    with pytest.raises(beltrami.InvalidArgumentError, match="no source"):
        beltrami.bake(image, SQUARE, SQUARE, **given)
    baked = beltrami.bake(image, SQUARE, SQUARE, cage=0.5, **given)
    np.testing.assert_array_equal(baked.images[0], image)


def test_what_rays_are_refused() -> None:
    image = np.zeros((1, 1), np.uint8)
    with pytest.raises(TypeError, match="old_uvs"):
        beltrami.bake(image, None, SQUARE)
    with pytest.raises(beltrami.InvalidArgumentError, match="rays"):
        beltrami.bake(image, None, SQUARE, pixels="occlusion", vertices=PLACES, rays=9999)
    with pytest.raises(ValueError, match="rays"):
        beltrami.bake(image, None, SQUARE, pixels="occlusion", vertices=PLACES, rays=-1)
    with pytest.raises(beltrami.InvalidArgumentError, match="rays"):
        beltrami.bake(image, SQUARE, SQUARE, rays=4)
    with pytest.raises(beltrami.InvalidArgumentError, match="cage"):
        beltrami.bake(image, SQUARE, SQUARE, cage=1)
