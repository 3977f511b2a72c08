//! Pairs of triangles whose boxes meet, found with a uniform grid.

use crate::reader::ReadTriangle;
use glam::DVec3;
use std::collections::{BTreeMap, BTreeSet};

/// Boxes this near count as meeting, in metres.
const REACH: f64 = 1e-6;

fn bounds(triangle: &ReadTriangle) -> (DVec3, DVec3) {
    let [a, b, c] = triangle.corners;
    let reach = DVec3::splat(REACH);
    (a.min(b).min(c) - reach, a.max(b).max(c) + reach)
}

/// Calls `visit` once for every pair of triangles `(i, j)`, `i < j`, whose boxes meet.
pub fn for_each_near_pair(triangles: &[ReadTriangle], mut visit: impl FnMut(usize, usize)) {
    let boxes: Vec<_> = triangles.iter().map(bounds).collect();
    let low = boxes.iter().fold(DVec3::INFINITY, |m, b| m.min(b.0));
    let high = boxes.iter().fold(DVec3::NEG_INFINITY, |m, b| m.max(b.1));
    let cell = (high - low).max_element() / (triangles.len() as f64).cbrt().clamp(1.0, 64.0);
    let mut cells: BTreeMap<[i64; 3], Vec<usize>> = BTreeMap::new();
    let place = |p: DVec3| ((p - low) / cell).floor().to_array().map(|x| x as i64);
    for (index, &(min, max)) in boxes.iter().enumerate() {
        let (from, to) = (place(min), place(max));
        for x in from[0]..=to[0] {
            for y in from[1]..=to[1] {
                for z in from[2]..=to[2] {
                    cells.entry([x, y, z]).or_default().push(index);
                }
            }
        }
    }
    let meet = |a: usize, b: usize| {
        boxes[a].0.cmple(boxes[b].1).all() && boxes[b].0.cmple(boxes[a].1).all()
    };
    for (at, members) in &cells {
        for (n, &i) in members.iter().enumerate() {
            for &j in &members[n + 1..] {
                // The pair belongs to the cell that holds the least corner of what they share.
                if meet(i, j) && place(boxes[i].0.max(boxes[j].0)) == *at {
                    visit(i.min(j), i.max(j));
                }
            }
        }
    }
}

#[test]
fn the_grid_finds_the_pairs_that_brute_force_finds() {
    let triangles = &crate::reader::read("cornell-spheres").triangles[..400];
    let mut found = BTreeSet::new();
    for_each_near_pair(triangles, |i, j| assert!(found.insert((i, j)), "twice"));
    let mut expected = BTreeSet::new();
    for i in 0..triangles.len() {
        for j in i + 1..triangles.len() {
            let (a, b) = (bounds(&triangles[i]), bounds(&triangles[j]));
            if a.0.cmple(b.1).all() && b.0.cmple(a.1).all() {
                expected.insert((i, j));
            }
        }
    }
    assert!(expected.len() > 400);
    assert_eq!(found, expected);
}
