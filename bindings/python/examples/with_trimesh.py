"""Cut a closed trimesh open, flatten it, and get a textured trimesh back.

Flattening takes disks: here a plane cuts a capsule, and what lies above it is one.
"""

# %%
import numpy as np
import trimesh

import beltrami

capsule = trimesh.creation.capsule(height=1.0, radius=0.5)
try:
    beltrami.parameterize(capsule)
except beltrami.NotADiskError as error:
    print(f"{error.status}: {error}")

# %%
keep = (capsule.triangles_center[:, 2] > 0.5) & (capsule.area_faces > 0)
cap = trimesh.Trimesh(capsule.vertices, capsule.faces[keep])  # unused vertices are dropped
result = beltrami.parameterize(cap)
print(f"{len(cap.faces)} faces, energy {result.energy.symmetric_dirichlet:.4f}")

# %% A copy with UVs: export it, or give its material an image.
textured = result.mesh
assert np.array_equal(textured.visual.uv, result.uv)
textured.export("cap.obj")
