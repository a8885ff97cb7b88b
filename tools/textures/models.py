"""Ten models with textures, each for another way in which textures and UVs are used."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from gltf import Gltf, Json, Shown, png

Point = tuple[float, float, float]
Uv = tuple[float, float]
Surface = Callable[[float, float], Point]


@dataclass
class Model:
    """A model, and how it is to be unwrapped and looked at."""

    gltf: Gltf
    about: str
    options: list[str] = field(default_factory=list)
    #: Where the camera is, looking at the centre of the model, in sizes of it.
    views: tuple[Point, ...] = ((0.9, 0.6, 1.2), (-1.1, 0.5, 0.7))


def _unit(p: Sequence[float]) -> Point:
    length = math.sqrt(sum(x * x for x in p)) or 1
    return (p[0] / length, p[1] / length, p[2] / length)


def _cross(a: Sequence[float], b: Sequence[float]) -> Point:
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


@dataclass
class Grid:
    """A surface over [0,1]^2 as a grid of triangles."""

    positions: list[Point] = field(default_factory=list)
    normals: list[Point] = field(default_factory=list)
    tangents: list[tuple[float, float, float, float]] = field(default_factory=list)
    uvs: list[Uv] = field(default_factory=list)
    triangles: list[tuple[int, int, int]] = field(default_factory=list)

    def add(
        self,
        surface: Surface,
        columns: int,
        rows: int,
        uv: Callable[[float, float], Uv] = lambda s, t: (s, 1 - t),
    ) -> Grid:
        """Add a sheet, and return the grid."""
        first = len(self.positions)
        step = 1e-4
        for j in range(rows + 1):
            for i in range(columns + 1):
                s, t = i / columns, j / rows
                self.positions.append(surface(s, t))
                # At a pole, where an axis has no length, the place beside it says what is out.
                s1, t1 = min(max(s, step), 1 - step), min(max(t, step), 1 - step)
                a, b = surface(s1 + step, t1), surface(s1 - step, t1)
                c, d = surface(s1, t1 + step), surface(s1, t1 - step)
                along = [x - y for x, y in zip(a, b)]
                up = [x - y for x, y in zip(c, d)]
                normal = _unit(_cross(along, up))
                self.normals.append(normal)
                self.uvs.append(uv(s, t))
                # Of UVs whose axes are those of the grid.
                side = 1.0 if uv(s1 + step, t)[0] > uv(s1 - step, t)[0] else -1.0
                inward = sum(x * n for x, n in zip(along, normal))
                x, y, z = _unit([side * (x - inward * n) for x, n in zip(along, normal)])
                self.tangents.append((x, y, z, side))
        for j in range(rows):
            for i in range(columns):
                k = first + j * (columns + 1) + i
                self.triangles += [
                    (k, k + 1, k + columns + 2),
                    (k, k + columns + 2, k + columns + 1),
                ]
        return self

    def attributes(self) -> dict[str, Sequence[Sequence[float]]]:
        """Return what a primitive has."""
        return {"POSITION": self.positions, "NORMAL": self.normals, "TEXCOORD_0": self.uvs}

    def with_tangents(self) -> dict[str, Sequence[Sequence[float]]]:
        """Return the same for normal maps, of which viewers have ideas of their own."""
        return {**self.attributes(), "TANGENT": self.tangents}


def _soft(x: float, width: float) -> float:
    """Return 0 far below 0 and 1 far above it, with nothing sharp between."""
    return 0.5 + 0.5 * math.tanh(x / width)


def _paint(phase: float = 0) -> Shown:
    def shown(x: float, y: float) -> Sequence[float]:
        a, b = 2 * math.pi * x, 2 * math.pi * y
        return (
            0.5 + 0.3 * math.sin(3 * a + phase) * math.cos(2 * b),
            0.45 + 0.3 * math.cos(4 * b + phase),
            0.5 + 0.3 * math.sin(a + 2 * b + phase),
        )

    return shown


def _tiles(x: float, y: float) -> Sequence[float]:
    edge = min(x, 1 - x, y, 1 - y)
    inside = _soft(edge - 0.06, 0.02)
    grain = 0.06 * math.sin(12 * math.pi * x) * math.sin(8 * math.pi * y)
    return tuple(inside * c + (1 - inside) * 0.3 + grain for c in (0.75, 0.45, 0.35))


def _bumps(times: int, height: float) -> Shown:
    def shown(x: float, y: float) -> Sequence[float]:
        a, b = 2 * math.pi * times * x, 2 * math.pi * times * y
        # The slopes of height * sin(a) sin(b), y down on the picture and up in the map.
        normal = _unit((-height * math.cos(a) * math.sin(b), height * math.sin(a) * math.cos(b), 1))
        return tuple(0.5 + 0.5 * n for n in normal)

    return shown


def _ball(s: float, t: float) -> Point:
    a, b = 2 * math.pi * s, math.pi * (t - 0.5)
    return (math.sin(a) * math.cos(b), math.sin(b), math.cos(a) * math.cos(b))


def _tube(radius: float, height: float) -> Surface:
    def at(s: float, t: float) -> Point:
        a = 2 * math.pi * s
        return (radius * math.sin(a), height * t, radius * math.cos(a))

    return at


def floor() -> Model:
    """Make a floor whose tiles repeat."""
    gltf = Gltf()
    base = gltf.texture(png(256, _tiles))
    material = gltf.material(pbrMetallicRoughness={"baseColorTexture": base, "metallicFactor": 0})
    grid = Grid().add(
        lambda s, t: (3 * s, 0.2 * math.sin(3 * s) * math.sin(2 * t), -3 * t),
        24,
        24,
        lambda s, t: (4 * s - 1, 4 * t - 2),
    )
    gltf.primitive(grid.attributes(), grid.triangles, material)
    return Model(gltf, "a picture that repeats, over UVs from -1 to 3")


def mirrored() -> Model:
    """Make a head of which both halves show one half of the picture."""
    gltf = Gltf()
    base = gltf.texture(png(512, _paint()))
    bumps = gltf.texture(png(512, _bumps(10, 0.8)))
    material = gltf.material(
        pbrMetallicRoughness={"baseColorTexture": base, "metallicFactor": 0},
        normalTexture=bumps,
    )
    grid = Grid()
    grid.add(lambda s, t: _ball(s / 2, t), 32, 32, lambda s, t: (0.05 + 0.9 * s, 1 - t))
    grid.add(lambda s, t: _ball(0.5 + s / 2, t), 32, 32, lambda s, t: (0.95 - 0.9 * s, 1 - t))
    gltf.primitive(grid.with_tangents(), grid.triangles, material)
    return Model(gltf, "two halves with mirrored UVs, colours and normals")


def tiles() -> Model:
    """Make pages side by side, as the tiles of UDIM."""
    gltf = Gltf()
    for page in range(2):
        base = gltf.texture(png(256, _paint(2.0 * page)))
        material = gltf.material(
            pbrMetallicRoughness={"baseColorTexture": base, "metallicFactor": 0}
        )
        grid = Grid().add(
            lambda s, t, page=page: _ball((s + page) / 2, t),
            32,
            32,
            lambda s, t, page=page: (page + 0.02 + 0.96 * s, 1 - t),
        )
        gltf.primitive(grid.attributes(), grid.triangles, material)
    return Model(gltf, "two pages on two tiles, with a material each")


def normals() -> Model:
    """Make a vase with a normal map and metal."""
    gltf = Gltf()
    bumps = gltf.texture(png(512, _bumps(8, 0.7)), scale=0.8)
    rough = gltf.texture(
        png(
            256,
            lambda x, y: (
                1.0,
                0.5 + 0.2 * math.sin(8 * math.pi * x),
                0.4 + 0.3 * math.sin(6 * math.pi * y),
            ),
        )
    )
    material = gltf.material(
        pbrMetallicRoughness={
            "metallicRoughnessTexture": rough,
            "baseColorFactor": [0.9, 0.7, 0.4, 1],
        },
        normalTexture=bumps,
    )

    def vase(s: float, t: float) -> Point:
        a, radius = 2 * math.pi * s, 0.6 + 0.25 * math.sin(5 * t)
        return (radius * math.sin(a), 2 * t, radius * math.cos(a))

    grid = Grid().add(vase, 48, 48)
    gltf.primitive(grid.with_tangents(), grid.triangles, material)
    return Model(gltf, "a normal map with a scale, and metal that varies")


def foliage() -> Model:
    """Make leaves on crossed sheets, cut out of them."""

    def leaf(x: float, y: float) -> Sequence[float]:
        across = abs(x - 0.5)
        alpha = _soft(0.42 * math.sin(math.pi * y) - across, 0.03)
        vein = 0.12 * math.cos(8 * math.pi * (y - across))
        return (0.25 + vein, 0.55 + vein, 0.15, alpha)

    gltf = Gltf()
    base = gltf.texture(png(256, leaf), 33071)
    material = gltf.material(
        pbrMetallicRoughness={
            "baseColorTexture": base,
            "metallicFactor": 0,
            "roughnessFactor": 0.9,
        },
        alphaMode="BLEND",
        doubleSided=True,
    )
    grid = Grid()
    for turn in range(3):
        c, s0 = math.cos(turn * math.pi / 3), math.sin(turn * math.pi / 3)
        grid.add(lambda s, t, c=c, d=s0: ((s - 0.5) * c, t, (s - 0.5) * d), 6, 6)
    gltf.primitive(grid.attributes(), grid.triangles, material)
    return Model(gltf, "leaves with an alpha")


def sets() -> Model:
    """Make a pot with a picture for each of two sets of UVs."""
    gltf = Gltf()
    base = gltf.texture(png(256, _tiles))
    shade = gltf.texture(png(256, lambda x, y: (0.5 + 0.5 * y, 0.0, 0.0)), texCoord=1)
    light = gltf.texture(
        png(256, lambda x, y: (0.0, 0.0, 0.3 + 0.3 * math.sin(4 * math.pi * x))), texCoord=1
    )
    material = gltf.material(
        pbrMetallicRoughness={"baseColorTexture": base, "metallicFactor": 0},
        occlusionTexture=shade,
        emissiveTexture=light,
        emissiveFactor=[1, 1, 1],
    )
    grid = Grid().add(_tube(0.7, 1.6), 48, 24, lambda s, t: (3 * s, 2 * t))
    attributes = grid.attributes()
    attributes["TEXCOORD_1"] = [(0.02 + 0.96 * u / 3, 0.02 + 0.96 * v / 2) for u, v in grid.uvs]
    gltf.primitive(attributes, grid.triangles, material)
    return Model(gltf, "two sets of UVs", views=((0.9, 1.0, 1.2), (-1.1, 0.5, 0.7)))


def skinned() -> Model:
    """Make a tube that two bones bend."""
    gltf = Gltf()
    base = gltf.texture(png(512, _paint()))
    material = gltf.material(pbrMetallicRoughness={"baseColorTexture": base, "metallicFactor": 0})
    grid = Grid().add(_tube(0.35, 2), 32, 32)
    attributes = grid.attributes()
    attributes["JOINTS_0"] = [(0, 1, 0, 0) for _ in grid.positions]
    weights = [min(max(p[1] - 0.5, 0.0), 1.0) for p in grid.positions]
    attributes["WEIGHTS_0"] = [(1 - w, w, 0, 0) for w in weights]
    gltf.primitive(attributes, grid.triangles, material)
    one = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
    moved = [*one[:13], -1, 0, 1]
    gltf.json["skins"] = [{"joints": [1, 2], "inverseBindMatrices": gltf.accessor([one, moved])}]
    bend = 0.5
    gltf.json["nodes"] = [
        {"mesh": 0, "skin": 0},
        {"children": [2]},
        {"translation": [0, 1, 0], "rotation": [0, 0, math.sin(bend / 2), math.cos(bend / 2)]},
    ]
    gltf.json["scenes"][0]["nodes"] = [0, 1]
    return Model(gltf, "a tube that bones bend")


def morphed() -> Model:
    """Make a ball half way to another shape."""
    gltf = Gltf()
    base = gltf.texture(png(512, _paint(1)))
    material = gltf.material(pbrMetallicRoughness={"baseColorTexture": base, "metallicFactor": 0})
    grid = Grid().add(_ball, 48, 32, lambda s, t: (0.02 + 0.96 * s, 0.98 - 0.96 * t))
    primitive = gltf.primitive(grid.attributes(), grid.triangles, material)
    shift = [(0.0, 0.4 * math.sin(3 * x) * math.cos(2 * z), 0.0) for x, _, z in grid.positions]
    primitive["targets"] = [{"POSITION": gltf.accessor(shift)}]
    gltf.json["meshes"][0]["weights"] = [0.7]
    return Model(gltf, "a morph target")


def merged() -> Model:
    """Make three materials that become one."""
    gltf = Gltf()
    looks: list[Json] = [
        {
            "pbrMetallicRoughness": {
                "baseColorTexture": gltf.texture(png(256, _tiles)),
                "metallicFactor": 0,
            }
        },
        {"pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.3, 0.6, 1], "metallicFactor": 0}},
        {
            "pbrMetallicRoughness": {
                "baseColorTexture": gltf.texture(png(256, _paint()), 33648),
                "baseColorFactor": [1, 0.7, 0.7, 1],
                "metallicFactor": 0,
                "roughnessFactor": 0.6,
            },
            "normalTexture": gltf.texture(png(256, _bumps(6, 0.6))),
        },
    ]
    for k, look in enumerate(looks):
        grid = Grid().add(
            lambda s, t, k=k: tuple(0.55 * x + d for x, d in zip(_ball(s, t), (1.2 * k, 0, 0))),
            32,
            24,
            lambda s, t: (1.9 * s, 1 - t),
        )
        gltf.primitive(grid.with_tangents(), grid.triangles, gltf.material(**look))
    return Model(
        gltf,
        "three materials that become one",
        ["--merge-materials"],
        ((0.4, 0.4, 1.3), (-0.4, 0.5, -1.2)),
    )


def transformed() -> Model:
    """Make a picture that the material turns and scales, with colours of vertices and a coat."""
    gltf = Gltf()
    gltf.json["extensionsUsed"] = ["KHR_texture_transform", "KHR_materials_clearcoat"]
    turn = {"KHR_texture_transform": {"offset": [0.2, 0.1], "rotation": 0.6, "scale": [2, 1.5]}}
    base = gltf.texture(png(256, _paint(0.5)), extensions=turn)
    coat = gltf.texture(png(256, lambda x, y: (0.5 + 0.3 * math.sin(6 * math.pi * x), 0.0, 0.0)))
    material = gltf.material(
        pbrMetallicRoughness={"baseColorTexture": base, "metallicFactor": 0},
        extensions={"KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatTexture": coat}},
    )
    grid = Grid().add(_ball, 48, 32, lambda s, t: (s, 1 - t))
    attributes = grid.attributes()
    attributes["COLOR_0"] = [(0.75 + 0.25 * y, 1.0, 0.75 - 0.25 * y) for _, y, _ in grid.positions]
    gltf.primitive(attributes, grid.triangles, material)
    return Model(gltf, "KHR_texture_transform, colours of vertices and a clear coat")


MODELS: dict[str, Callable[[], Model]] = {
    made.__name__: made
    for made in (
        floor,
        mirrored,
        tiles,
        normals,
        foliage,
        sets,
        skinned,
        morphed,
        merged,
        transformed,
    )
}
