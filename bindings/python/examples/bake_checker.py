"""Bake a checkerboard into a texture, and write a model that carries it: OBJ, MTL and PNG."""

# %%
from pathlib import Path

import matplotlib as mpl
import numpy as np

import beltrami

mpl.use("Agg")
from matplotlib import pyplot as plt

# %% Half a cylinder, closed by nothing: it flattens without distortion.
ROWS, COLUMNS = 20, 60
height, angle = np.meshgrid(np.linspace(0, 2, ROWS + 1), np.linspace(0, np.pi, COLUMNS + 1))
vertices = np.stack([np.cos(angle).ravel(), height.ravel(), np.sin(angle).ravel()], axis=1)
corner = (np.arange(COLUMNS)[:, None] * (ROWS + 1) + np.arange(ROWS)).ravel()
a, b, c = corner, corner + ROWS + 1, corner + 1
faces = np.concatenate([np.stack([a, b, c], 1), np.stack([b, b + 1, c], 1)])

# %% Textures take UVs in the unit square, in single precision.
result = beltrami.parameterize(vertices, faces, unit_square=True, float32=True)
assert result.injective
print(f"UVs from {result.uv.min(axis=0)} to {result.uv.max(axis=0)}, {result.uv.dtype}")

# %%
PIXELS, CELLS = 1024, 16
cell = np.arange(PIXELS) * CELLS // PIXELS
checker = (cell[:, None] + cell) % 2
colours = np.array([[0.95, 0.94, 0.91], [0.27, 0.43, 0.62]])
plt.imsave("checker.png", colours[checker])
Path("checker.mtl").write_text("newmtl checker\nmap_Kd checker.png\n")
with Path("checker.obj").open("w") as obj:
    obj.write("mtllib checker.mtl\nusemtl checker\n")
    np.savetxt(obj, vertices, "v %.9g %.9g %.9g")
    np.savetxt(obj, result.uv, "vt %.9g %.9g")
    np.savetxt(obj, np.repeat(faces + 1, 2, axis=1), "f %d/%d %d/%d %d/%d")
