//! Meshes made for the tests.

use std::f64::consts::TAU;

/// Positions and faces.
pub type Surface = (Vec<[f64; 3]>, Vec<[u32; 3]>);

/// A bumpy sheet of `cells` by `cells` squares, each cut in two.
pub fn sheet(cells: u32) -> Surface {
    let side = cells + 1;
    let position = |i: u32, j: u32| {
        let (x, y) =
            (10.0 * f64::from(i) / f64::from(cells), 10.0 * f64::from(j) / f64::from(cells));
        [x, y, x.sin() * (0.8 * y).cos()]
    };
    let square = |i: u32, j: u32| {
        let a = j * side + i;
        [[a, a + 1, a + side + 1], [a, a + side + 1, a + side]]
    };
    let positions = (0..side).flat_map(|j| (0..side).map(move |i| position(i, j))).collect();
    let faces = (0..cells).flat_map(|j| (0..cells).flat_map(move |i| square(i, j))).collect();
    (positions, faces)
}

/// A flat spiral staircase: a strip of `steps` squares whose boundary crosses itself after a whole
/// turn where it is laid out without care, rising by `rise` per turn.
#[allow(dead_code)] // not every test has it
pub fn spiral(steps: u32, turns: f64, rise: f64) -> Surface {
    let edge = |step: u32| {
        let turn = turns * f64::from(step) / f64::from(steps);
        let (sin, cos) = (TAU * turn).sin_cos();
        [1.0, 2.0].map(|radius| [radius * cos, radius * sin, rise * turn])
    };
    let positions = (0..=steps).flat_map(edge).collect();
    let square = |step: u32| {
        let a = 2 * step;
        [[a, a + 1, a + 3], [a, a + 3, a + 2]]
    };
    (positions, (0..steps).flat_map(square).collect())
}

/// In single precision.
#[allow(dead_code)]
pub fn single(positions: &[[f64; 3]]) -> Vec<[f32; 3]> {
    positions.iter().map(|p| p.map(|x| x as f32)).collect()
}
