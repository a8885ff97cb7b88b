"""Unwrap a mesh that is no disk: two closed bodies of quads, cut into charts where they bend."""

# %%
import numpy as np

import beltrami

corners = np.array([(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)], float)
sides = np.array(
    [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6]]
)
vertices = np.concatenate([corners, corners + np.array([2, 0, 0])])
faces = np.concatenate([sides, sides + 8])

atlas = beltrami.unwrap(vertices, faces)
print(f"{len(atlas.charts)} charts, energy {atlas.energy:.4f}, injective: {atlas.injective}")

# %% Charts with sharp edges between them keep all lengths.
atlas = beltrami.unwrap(vertices, faces, hard_angle=60, resolution=512, margin=4)
print(f"{len(atlas.charts)} charts, energy {atlas.energy:.4f}, injective: {atlas.injective}")

# %% What a vertex buffer needs: vertices split along the seams, and nowhere else.
positions, index_buffer, uvs = atlas.split()
np.savez("boxes.npz", positions=positions, faces=index_buffer, uvs=uvs)
print(f"{len(vertices)} vertices became {len(positions)}")
