"""Compare the energies, and the methods, on one mesh; draw what they do.

Run it with the path of an OBJ file that has one disk, or it takes a square with a hump.
"""

# %%
import sys
from pathlib import Path

import matplotlib as mpl
import numpy as np

import beltrami
from beltrami import plot

mpl.use("Agg")
from matplotlib import pyplot as plt


def read_obj(path):
    """Return vertices (n, 3) and faces (m, 3) of an OBJ file of triangles."""
    text = Path(path).read_text()
    lines = [line.split() for line in text.splitlines() if line[:2] in ("v ", "f ")]
    vertices = [words[1:4] for words in lines if words[0] == "v"]
    faces = [[w.split("/")[0] for w in words[1:4]] for words in lines if words[0] == "f"]
    return np.array(vertices, float), np.array(faces, int) - 1


def hump(rows=40):
    """Return vertices (n, 3) and faces (m, 3) of a square with a hump."""
    x, y = np.meshgrid(np.linspace(-1, 1, rows + 1), np.linspace(-1, 1, rows + 1))
    corner = (np.arange(rows)[:, None] * (rows + 1) + np.arange(rows)).ravel()
    a, b, c = corner, corner + 1, corner + rows + 1
    vertices = np.stack([x.ravel(), y.ravel(), np.exp(-4 * (x**2 + y**2)).ravel()], axis=1)
    return vertices, np.concatenate([np.stack([a, b, c], 1), np.stack([b, c + 1, c], 1)])


vertices, faces = read_obj(sys.argv[1]) if len(sys.argv) > 1 else hump()

# %%
RUNS = {
    "symmetric Dirichlet": {"energy": "symmetric-dirichlet"},
    "symmetric ARAP": {"energy": "symmetric-arap"},
    "exponential": {"energy": "exponential-dirichlet"},
    "harmonic": {"flatten": "dirichlet"},
    "Tutte": {"method": "tutte"},
}
results = {name: beltrami.parameterize(vertices, faces, **run) for name, run in RUNS.items()}
print(f"{'':20} {'Dirichlet':>10} {'at most':>10} {'ARAP':>10} {'injective':>10} {'seconds':>8}")
for name, result in results.items():
    energy = result.energy
    print(
        f"{name:20} {energy.symmetric_dirichlet:10.4f} {energy.max:10.4g} "
        f"{energy.symmetric_arap:10.4f} "
        f"{result.injective!s:>10} {result.report.seconds:8.3f}"
    )

# %%
figure, axes = plt.subplots(2, 3, figsize=(16, 9), layout="constrained")
for ax, (name, result) in zip(axes.flat, results.items()):
    plot.heat_map(vertices, faces, result.uv, ax, limit=4.0, resolution=600)
    ax.set_title(name)
axes.flat[-1].axis("off")
figure.savefig("energies.png", dpi=110)
