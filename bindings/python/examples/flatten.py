"""Flatten a mesh, look at the result, keep it.

Cells begin with `# %%`: editors and Jupyter run them one by one.
"""

# %%
from pathlib import Path

import numpy as np

import beltrami

# A square with a hump, as any arrays of vertices and faces would do.
ROWS = 60
x, y = np.meshgrid(np.linspace(-1, 1, ROWS + 1), np.linspace(-1, 1, ROWS + 1))
z = 0.8 * np.exp(-4 * (x**2 + y**2))
vertices = np.stack([x.ravel(), y.ravel(), z.ravel()], axis=1)
corner = (np.arange(ROWS)[:, None] * (ROWS + 1) + np.arange(ROWS)).ravel()
right, above = corner + 1, corner + ROWS + 1
faces = np.concatenate(
    [np.stack([corner, right, above], 1), np.stack([right, above + 1, above], 1)]
)

# %%
result = beltrami.parameterize(vertices, faces, threads=2, progress=True)
print(f"{len(faces)} faces, injective: {result.injective}")
print(f"energy: {result.energy.symmetric_dirichlet:.4f} (2 is isometric)")
for stage in result.stages:
    print(f"  {stage.name:10} {stage.seconds:.3f} s")

# %% The UVs are in the unit of length of the mesh; this is how much each face is distorted.
found = beltrami.distortion(vertices, faces, result.uv)
worst = int(found.symmetric_dirichlet.argmax())
print(f"the worst is face {worst}: s1, s2 = {found.singular_values[worst]}")

# %% What is shipped in single precision should be judged in single precision.
shipped = result.uv.astype(np.float32)
print(f"still injective when rounded: {bool(beltrami.check_injective(shipped, faces))}")

# %%
np.savez(Path("hump.npz"), vertices=vertices, faces=faces, uv=result.uv)
