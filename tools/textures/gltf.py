"""glTF files of a few triangles, and the pictures in them, by the standard library alone."""

from __future__ import annotations

import json
import struct
import zlib
from collections.abc import Callable, Sequence
from typing import Any

#: What a picture shows at a place of [0,1]^2, rows from the top: three or four numbers in [0,1].
Shown = Callable[[float, float], Sequence[float]]
Json = dict[str, Any]

_TYPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4", 16: "MAT4"}
_COMPONENTS = {"f": 5126, "H": 5123, "I": 5125, "B": 5121}


def png(side: int, shown: Shown) -> bytes:
    """Return a PNG file of `side` texels, of three components or four."""
    rows = []
    channels = 3
    for row in range(side):
        line = bytearray(1)
        for column in range(side):
            texel = shown((column + 0.5) / side, (row + 0.5) / side)
            channels = len(texel)
            line += bytes(max(0, min(255, round(255 * value))) for value in texel)
        rows.append(bytes(line))

    def chunk(kind: bytes, data: bytes) -> bytes:
        checked = kind + data
        return struct.pack(">I", len(data)) + checked + struct.pack(">I", zlib.crc32(checked))

    head = struct.pack(">IIBBBBB", side, side, 8, {3: 2, 4: 6}[channels], 0, 0, 0)
    data = zlib.compress(b"".join(rows), 6)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", data) + chunk(b"IEND", b"")


class Gltf:
    """A document that grows; `json` is for the model to edit."""

    def __init__(self) -> None:
        """Begin with nothing in it."""
        self.json: Json = {
            "asset": {"version": "2.0"},
            "scene": 0,
            "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": []}],
            "materials": [],
            "accessors": [],
            "bufferViews": [],
        }
        self._buffer = b""

    def view(self, data: bytes) -> int:
        """Return the number of a buffer view of these bytes."""
        self._buffer += b"\0" * (-len(self._buffer) % 4)
        view = {"buffer": 0, "byteOffset": len(self._buffer), "byteLength": len(data)}
        self.json["bufferViews"].append(view)
        self._buffer += data
        return len(self.json["bufferViews"]) - 1

    def accessor(self, items: Sequence[Sequence[float]], kind: str = "f") -> int:
        """Return the number of an accessor of these items."""
        width = len(items[0])
        numbers = [number for item in items for number in item]
        accessor = {
            "bufferView": self.view(struct.pack(f"<{len(numbers)}{kind}", *numbers)),
            "componentType": _COMPONENTS[kind],
            "count": len(items),
            "type": _TYPES[width],
        }
        if width == 3 and kind == "f":
            single = struct.unpack(f"<{len(numbers)}f", struct.pack(f"<{len(numbers)}f", *numbers))
            accessor["min"] = [min(single[k::3]) for k in range(3)]
            accessor["max"] = [max(single[k::3]) for k in range(3)]
        self.json["accessors"].append(accessor)
        return len(self.json["accessors"]) - 1

    def texture(self, data: bytes, wrap: int = 10497, **info: Any) -> Json:
        """Return what a material says of a new texture of this picture."""
        json_ = self.json
        images = json_.setdefault("images", [])
        images.append({"bufferView": self.view(data), "mimeType": "image/png"})
        json_.setdefault("samplers", []).append(
            {"magFilter": 9729, "minFilter": 9987, "wrapS": wrap, "wrapT": wrap}
        )
        number = len(images) - 1
        json_.setdefault("textures", []).append({"sampler": number, "source": number})
        return {"index": number, **info}

    def material(self, **material: Any) -> int:
        """Return the number of a new material."""
        self.json["materials"].append(material)
        return len(self.json["materials"]) - 1

    def primitive(
        self,
        attributes: dict[str, Sequence[Sequence[float]]],
        triangles: Sequence[Sequence[int]],
        material: int,
    ) -> Json:
        """Return a new primitive of the one mesh."""
        kinds = {"JOINTS_0": "H"}
        primitive = {
            "attributes": {
                name: self.accessor(items, kinds.get(name, "f"))
                for name, items in attributes.items()
            },
            "indices": self.accessor([[i] for triangle in triangles for i in triangle], "I"),
            "material": material,
        }
        self.json["meshes"][0]["primitives"].append(primitive)
        return primitive

    def glb(self) -> bytes:
        """Return the bytes of a .glb file."""
        chunk = self._buffer + b"\0" * (-len(self._buffer) % 4)
        text = json.dumps({**self.json, "buffers": [{"byteLength": len(chunk)}]}).encode()
        text += b" " * (-len(text) % 4)
        size = 12 + 8 + len(text) + 8 + len(chunk)
        return (
            b"glTF"
            + struct.pack("<II", 2, size)
            + struct.pack("<I", len(text))
            + b"JSON"
            + text
            + struct.pack("<I", len(chunk))
            + b"BIN\0"
            + chunk
        )
