"""What edits cost: seams opened and closed, pins dragged, faces selected, charts packed.

    session.py [--faces 5000 22000 89000 300000] [--edits 200] [--steps 1] [--record]

Each mesh is a body with limbs, cut by the seams of an unwrap at quick effort: the smallest into one
chart. Edits are random, the same at every run, on one thread, and each is followed by one update of
--steps Newton steps a chart. CPU time of the updates is told, and the mean energy after two updates
beside that of the same seams and pins from nothing.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import records
from evaluate_data import body

import beltrami

LENGTH = 6  # edges that a seam is opened by
COLD = 25  # edits from one comparison to the next


class Player:
    """Edits of one session, at random."""

    def __init__(self, vertices: np.ndarray, faces: np.ndarray, seams: np.ndarray, seed: int):
        self.editor = beltrami.Editor(vertices, faces, seams=seams)
        self.editor.update()
        self.editor.pack()
        self.random = np.random.default_rng(seed)
        ends = np.sort(np.concatenate([faces[:, [k, (k + 1) % 3]] for k in range(3)]), axis=1)
        self.neighbours: dict[int, list[int]] = {}
        for a, b in np.unique(ends, axis=0).tolist():
            self.neighbours.setdefault(a, []).append(b)
            self.neighbours.setdefault(b, []).append(a)
        self.cut = {tuple(edge) for edge in np.sort(seams, axis=1).tolist()}
        self.cut |= {tuple(edge) for edge in np.sort(self.editor.opened, axis=1).tolist()}
        self.on_seams = sorted({v for edge in self.cut for v in edge})
        self.opened: list[tuple[int, int]] = []
        self.faces = faces

    def seam(self) -> None:
        """Open a seam from one that is there, or close it again."""
        if self.opened:
            self.editor.close_seams(self.opened)
            self.opened = []
            return
        at = int(self.random.choice(self.on_seams))
        before, visited = at, {at}
        while len(self.opened) < LENGTH:
            ways = [v for v in self.neighbours[at] if v not in visited]
            ways = [v for v in ways if (min(at, v), max(at, v)) not in self.cut]
            if not ways:
                break
            before, at = at, int(self.random.choice(ways))
            visited.add(at)
            self.opened.append((before, at))
        if self.opened:
            self.editor.open_seams(self.opened)

    def pins(self) -> None:
        """Pin three corners of a chart, one of them a little off its place."""
        charts = self.editor.chart_of_face
        own = np.flatnonzero(charts == charts[self.random.integers(len(charts))])
        corners = 3 * self.random.choice(own, min(3, len(own)), replace=False)
        uvs = self.editor.corner_uvs
        box = np.ptp(uvs[(3 * own[:, None] + np.arange(3)).ravel()], axis=0)
        places = uvs[corners]
        places[-1] += 0.02 * box * self.random.uniform(-1, 1, 2)
        self.editor.set_pins(corners, places)

    def release(self) -> None:
        """Take the pins off."""
        self.editor.set_pins([], np.empty((0, 2)))

    def select(self) -> None:
        """Let the faces around a vertex move alone."""
        faces = [int(self.random.integers(len(self.faces)))]
        near = np.isin(self.faces, self.faces[faces]).any(axis=1)
        for _ in range(8):
            near = np.isin(self.faces, self.faces[near]).any(axis=1)
        self.editor.select(np.flatnonzero(near))

    def deselect(self) -> None:
        """Let all faces move."""
        self.editor.select(None)


def play(
    vertices: np.ndarray, faces: np.ndarray, seams: np.ndarray, edits: int, steps: int
) -> dict[str, Any]:
    """Return the figures of a session."""
    player = Player(vertices, faces, seams, 1)
    editor = player.editor
    turns: Sequence[Callable[[], None]] = [
        player.seam,
        player.seam,
        player.pins,
        player.release,
        player.select,
        player.deselect,
    ]
    spent: dict[str, list[float]] = {}
    ratios = []
    wrong = 0
    for edit in range(edits):
        turn = turns[edit % len(turns)]
        turn()
        start = time.process_time()
        try:
            editor.update(steps=steps)
        except beltrami.PinError:
            player.release()
        spent.setdefault(turn.__name__, []).append(time.process_time() - start)
        wrong += any(chart.status == "BELTRAMI_NOT_INJECTIVE" for chart in editor.charts)
        if edit % COLD == 1:
            editor.update(steps=steps)
            warm, mark = editor.report.symmetric_dirichlet, editor.save()
            editor.renew([chart.id for chart in editor.charts], cold=True)
            editor.update()
            ratios.append(warm / editor.report.symmetric_dirichlet)
            editor.restore(mark)
            editor.forget(mark)
    start = time.process_time()
    editor.pack()
    row: dict[str, Any] = {
        "charts": len(editor.charts),
        "largest": max(chart.triangles for chart in editor.charts),
        "not_injective": wrong,
        "pack_seconds": round(time.process_time() - start, 4),
        "worst_ratio": round(max(ratios), 5),
        "mean_ratio": round(float(np.mean(ratios)), 5),
    }
    for name, times in spent.items():
        row[f"{name}_p50"] = round(float(np.quantile(times, 0.5)), 4)
        row[f"{name}_p99"] = round(float(np.quantile(times, 0.99)), 4)
    editor.close()
    return row


def main() -> None:
    """Play a session on each mesh and print its figures."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--faces", type=int, nargs="+", default=[5_000, 22_000, 89_000, 300_000])
    parser.add_argument("--edits", type=int, default=200)
    parser.add_argument("--steps", type=int, default=1)
    records.add_option(parser)
    args = parser.parse_args()
    rows = []
    for count in args.faces:
        vertices, faces = body(1, count)
        energy = 5.0 if count == min(args.faces) else 2.05
        atlas = beltrami.unwrap(vertices, faces, target_energy=energy, effort="quick")
        row = {"faces": len(faces), "steps": args.steps, "edits": args.edits}
        row.update(play(vertices, faces, np.asarray(atlas.seams), args.edits, args.steps))
        rows.append(row)
        print(", ".join(f"{name} {value}" for name, value in row.items()), flush=True)
    if args.record:
        records.write("session", rows)


if __name__ == "__main__":
    main()
