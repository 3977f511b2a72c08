//! How two triangles meet: overlapping in one plane, or one piercing the other.

use crate::reader::ReadTriangle;
use glam::DVec3;

/// Distances below this are contact, not penetration, in metres: ten times the written precision.
const TOUCH: f64 = 1e-5;

/// Area that two triangles share when they lie in one plane and face the same way, else 0.
pub fn shared_area(a: &ReadTriangle, b: &ReadTriangle) -> f64 {
    let (na, nb) = (a.cross().normalize(), b.cross().normalize());
    if na.dot(nb) < 1.0 - 1e-6 {
        return 0.0;
    }
    let off_plane = |p: &DVec3| (*p - a.corners[0]).dot(na).abs() > TOUCH;
    if b.corners.iter().any(off_plane) {
        return 0.0;
    }
    let mut polygon = b.corners.to_vec();
    for k in 0..3 {
        let (from, to) = (a.corners[k], a.corners[(k + 1) % 3]);
        let inward = na.cross(to - from).normalize();
        polygon = clip(&polygon, from, inward);
    }
    if polygon.len() < 3 {
        return 0.0;
    }
    let fan = polygon[1..].windows(2);
    fan.map(|p| (p[0] - polygon[0]).cross(p[1] - polygon[0]).dot(na))
        .sum::<f64>()
        * 0.5
}

fn clip(polygon: &[DVec3], on_border: DVec3, inward: DVec3) -> Vec<DVec3> {
    let mut kept = Vec::new();
    for (i, &p) in polygon.iter().enumerate() {
        let q = polygon[(i + 1) % polygon.len()];
        let (dp, dq) = ((p - on_border).dot(inward), (q - on_border).dot(inward));
        if dp >= 0.0 {
            kept.push(p);
        }
        if (dp > 0.0) != (dq > 0.0) && dp != dq {
            kept.push(p + (q - p) * (dp / (dp - dq)));
        }
    }
    kept
}

/// True when an edge of one triangle passes through the inside of the other.
pub fn pierces(a: &ReadTriangle, b: &ReadTriangle) -> bool {
    edge_through(a, b) || edge_through(b, a)
}

fn edge_through(a: &ReadTriangle, b: &ReadTriangle) -> bool {
    let normal = b.cross().normalize();
    let depth = |p: DVec3| (p - b.corners[0]).dot(normal);
    (0..3).any(|k| {
        let (p, q) = (a.corners[k], a.corners[(k + 1) % 3]);
        let (dp, dq) = (depth(p), depth(q));
        if dp.abs() < TOUCH || dq.abs() < TOUCH || (dp > 0.0) == (dq > 0.0) {
            return false;
        }
        let crossing = p + (q - p) * (dp / (dp - dq));
        (0..3).all(|e| {
            let (from, to) = (b.corners[e], b.corners[(e + 1) % 3]);
            (crossing - from).dot(normal.cross(to - from).normalize()) > TOUCH
        })
    })
}

fn triangle(corners: [[f64; 3]; 3]) -> ReadTriangle {
    ReadTriangle {
        corners: corners.map(DVec3::from),
        material: String::new(),
        object: 0,
    }
}

#[test]
fn shared_area_is_that_of_the_overlap() {
    let a = triangle([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]]);
    let b = triangle([[1.0, 0.0, 0.0], [3.0, 0.0, 0.0], [1.0, 2.0, 0.0]]);
    // They share the triangle (1,0) (2,0) (1,1).
    assert!((shared_area(&a, &b) - 0.5).abs() < 1e-12);
    let beside = triangle([[2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0]]);
    assert!(shared_area(&a, &beside) < 1e-12);
    let turned = triangle([[1.0, 0.0, 0.0], [1.0, 2.0, 0.0], [3.0, 0.0, 0.0]]);
    assert_eq!(shared_area(&a, &turned), 0.0);
}

#[test]
fn piercing_is_told_from_touching() {
    let floor = triangle([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]]);
    let through = triangle([[0.5, 0.5, -1.0], [0.6, 0.5, 1.0], [0.5, 0.6, 1.0]]);
    let standing = triangle([[0.5, 0.5, 0.0], [0.6, 0.5, 1.0], [0.5, 0.6, 1.0]]);
    assert!(pierces(&floor, &through) && pierces(&through, &floor));
    assert!(!pierces(&floor, &standing));
}
