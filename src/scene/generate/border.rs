//! The border between air and solid as a watertight mesh of rectangles.
//!
//! Cells of one paint are joined into rectangles up to the size asked for, so that a cut that one
//! corner of a room needs does not run through all the others. Every rectangle then takes the
//! corners of its neighbours that lie on its sides as vertices of its own, which leaves no
//! T-junction.

use super::cell_grid::{BorderFace, Cell, CellGrid};
use super::material::Material;
use super::mesh::{MaterialId, Mesh};
use super::weakly_convex::triangulate;
use glam::{DVec3, dvec3};
use std::collections::{BTreeMap, BTreeSet};

/// How far a joined rectangle may exceed the size asked for: leaves no strips beside features.
const STRETCH: f64 = 1.25;

/// A rectangle this many times longer than wide is a strip: a corner on only one of its long sides
/// would leave a sliver of a triangle.
const STRIP: f64 = 8.0;

/// What a cell of a layer shows: its paint and the room in front of it.
type Shown = Option<(MaterialId, u16)>;

/// A vertex of the grid.
type Corner = [usize; 3];

/// A rectangle of the border in grid indices.
#[derive(Clone, Copy)]
struct Rectangle {
    axis: usize,
    /// True when the air lies above along the axis.
    up: bool,
    low: Corner,
    high: Corner,
    material: MaterialId,
}

/// The mesh of the border of `grid`, whose cells lie between `lines`; no rectangle much exceeds
/// `size` (metres along each axis).
pub fn border_mesh(
    grid: &CellGrid,
    lines: &[Vec<f64>; 3],
    size: DVec3,
    paint: impl Fn(&BorderFace) -> Material,
) -> Mesh {
    let mut mesh = Mesh::default();
    let mut rectangles = Vec::new();
    for axis in 0..3 {
        for at in 0..lines[axis].len() {
            for up in [false, true] {
                let layer = shown(grid, lines, axis, at, up, &mut mesh, &paint);
                join(layer, lines, size, axis, at, up, &mut rectangles);
            }
        }
    }
    let corners = cut_strips(&mut rectangles, lines);
    let mut vertices = BTreeMap::new();
    for (number, rectangle) in rectangles.iter().enumerate() {
        let mut outline: Vec<usize> = rectangle
            .outline(&corners)
            .into_iter()
            .map(|corner| {
                *vertices
                    .entry(corner)
                    .or_insert_with(|| mesh.vertex(position(lines, corner)))
            })
            .collect();
        if !rectangle.up {
            outline.reverse();
        }
        if outline.len() == 4 && number % 2 == 1 {
            // Diagonals take turns, so that no direction is favoured.
            outline.rotate_left(1);
        }
        for triangle in triangulate(&outline, &mesh.vertices) {
            mesh.triangle(triangle, rectangle.material);
        }
    }
    mesh
}

fn position(lines: &[Vec<f64>; 3], [i, j, k]: Corner) -> DVec3 {
    dvec3(lines[0][i], lines[1][j], lines[2][k])
}

/// The two axes of a layer, in right-handed order.
fn layer_axes(axis: usize) -> (usize, usize) {
    ((axis + 1) % 3, (axis + 2) % 3)
}

/// What shows in the plane `at` across `axis`, row by row along the second layer axis.
fn shown(
    grid: &CellGrid,
    lines: &[Vec<f64>; 3],
    axis: usize,
    at: usize,
    up: bool,
    mesh: &mut Mesh,
    paint: &impl Fn(&BorderFace) -> Material,
) -> Vec<Vec<Shown>> {
    let (u, v) = layer_axes(axis);
    let mut normal = DVec3::ZERO;
    normal[axis] = if up { 1.0 } else { -1.0 };
    let mut cell = |i: usize, j: usize| -> Shown {
        let mut above = [0; 3];
        (above[axis], above[u], above[v]) = (at as isize, i as isize, j as isize);
        let mut below = above;
        below[axis] -= 1;
        let (air, solid) = match (grid.at(below), grid.at(above), up) {
            (Cell::Solid(solid), Cell::Air(air), true)
            | (Cell::Air(air), Cell::Solid(solid), false) => (air, solid),
            _ => return None,
        };
        let (mut low, mut high) = ([0; 3], [0; 3]);
        (low[axis], low[u], low[v]) = (at, i, j);
        (high[axis], high[u], high[v]) = (at, i + 1, j + 1);
        let material = paint(&BorderFace {
            air,
            solid,
            normal,
            centre: (position(lines, low) + position(lines, high)) * 0.5,
        });
        Some((mesh.material(material), air))
    };
    (0..lines[v].len() - 1)
        .map(|j| (0..lines[u].len() - 1).map(|i| cell(i, j)).collect())
        .collect()
}

/// Joins the cells of a layer into rectangles: greedily, first along its first axis.
fn join(
    mut layer: Vec<Vec<Shown>>,
    lines: &[Vec<f64>; 3],
    size: DVec3,
    axis: usize,
    at: usize,
    up: bool,
    rectangles: &mut Vec<Rectangle>,
) {
    let (u, v) = layer_axes(axis);
    let fits = |axis: usize, from: usize, to: usize| {
        lines[axis][to] - lines[axis][from] <= size[axis] * STRETCH
    };
    for j in 0..layer.len() {
        for i in 0..layer[j].len() {
            let Some(shows) = layer[j][i] else { continue };
            let mut right = i + 1;
            while right < layer[j].len() && layer[j][right] == Some(shows) && fits(u, i, right + 1)
            {
                right += 1;
            }
            let mut top = j + 1;
            while top < layer.len()
                && fits(v, j, top + 1)
                && layer[top][i..right].iter().all(|&s| s == Some(shows))
            {
                top += 1;
            }
            for row in &mut layer[j..top] {
                row[i..right].fill(None);
            }
            let (mut low, mut high) = ([0; 3], [0; 3]);
            (low[axis], low[u], low[v]) = (at, i, j);
            (high[axis], high[u], high[v]) = (at, right, top);
            rectangles.push(Rectangle {
                axis,
                up,
                low,
                high,
                material: shows.0,
            });
        }
    }
}

/// Cuts strips across wherever a neighbour has a corner on a long side, until none is left to cut.
/// Gives all corners.
fn cut_strips(rectangles: &mut Vec<Rectangle>, lines: &[Vec<f64>; 3]) -> BTreeSet<Corner> {
    loop {
        let corners: BTreeSet<Corner> = rectangles.iter().flat_map(Rectangle::corners).collect();
        let before = rectangles.len();
        *rectangles = std::mem::take(rectangles)
            .into_iter()
            .flat_map(|rectangle| rectangle.cut_if_strip(lines, &corners))
            .collect();
        if rectangles.len() == before {
            return corners;
        }
    }
}

impl Rectangle {
    fn cut_if_strip(self, lines: &[Vec<f64>; 3], corners: &BTreeSet<Corner>) -> Vec<Self> {
        let (u, v) = layer_axes(self.axis);
        let extent = |axis: usize| lines[axis][self.high[axis]] - lines[axis][self.low[axis]];
        let long = if extent(u) > extent(v) { u } else { v };
        let short = u + v - long;
        if extent(long) <= STRIP * extent(short) {
            return vec![self];
        }
        let mut cuts = vec![self.low[long]];
        cuts.extend((self.low[long] + 1..self.high[long]).filter(|&at| {
            let (mut one, mut other) = (self.low, self.high);
            (one[long], other[long]) = (at, at);
            corners.contains(&one) || corners.contains(&other)
        }));
        cuts.push(self.high[long]);
        cuts.windows(2)
            .map(|pair| {
                let (mut low, mut high) = (self.low, self.high);
                (low[long], high[long]) = (pair[0], pair[1]);
                Self { low, high, ..self }
            })
            .collect()
    }

    fn corners(&self) -> [Corner; 4] {
        let (u, v) = layer_axes(self.axis);
        let corner = |i: usize, j: usize| {
            let mut corner = self.low;
            (corner[u], corner[v]) = (i, j);
            corner
        };
        [
            corner(self.low[u], self.low[v]),
            corner(self.high[u], self.low[v]),
            corner(self.high[u], self.high[v]),
            corner(self.low[u], self.high[v]),
        ]
    }

    /// The corners of any rectangle that lie on this one's sides, counter-clockwise seen from
    /// above along the axis, beginning with its own least corner.
    fn outline(&self, corners: &BTreeSet<Corner>) -> Vec<Corner> {
        let own = self.corners();
        let mut outline = Vec::new();
        for k in 0..4 {
            let (from, to) = (own[k], own[(k + 1) % 4]);
            let mut at = from;
            while at != to {
                if corners.contains(&at) {
                    outline.push(at);
                }
                for axis in 0..3 {
                    match at[axis].cmp(&to[axis]) {
                        std::cmp::Ordering::Less => at[axis] += 1,
                        std::cmp::Ordering::Greater => at[axis] -= 1,
                        std::cmp::Ordering::Equal => {}
                    }
                }
            }
        }
        outline
    }
}
