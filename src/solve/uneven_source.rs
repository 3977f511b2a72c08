//! What an unevenly lit source sends towards a receiver.
//!
//! A form factor takes its source for evenly lit. The parts of a source that a receiver sees best count for more than the
//! others, and where light changes over the source as the view of it does, the mean radiosity is the wrong one: corners of
//! rooms are darker than walls and see mostly each other, so that with the means of whole walls every bounce loses some
//! three thousandths of the light. Here the radiosity that counts is that of a linear function over the source, at the
//! centre of what the receiver sees of it.

use super::composite_rule::three_points;
use super::element::{Element, Shape};
use super::radiosity::Shooter;
use glam::Vec3;

/// Gap, in radii of the receiver, below which the view of the source changes over the receiver.
const NEAR: f32 = 4.0;

/// How much more a facet or patch with these corners sends towards a receiver than its mean radiosity, channel by channel,
/// from [`LEAST`] to [`MOST`]: 1 for one without children, of whose light no more is known.
pub(super) fn triangle_towards<const C: usize>(
    shooter: &Shooter<C>,
    slot: u32,
    (source, corners): (&Element, [Vec3; 3]),
    receiver: &Element,
) -> [f64; C] {
    let split = &shooter.splits[slot as usize];
    if split.first == 0 || split.variance <= 0.0 {
        return [1.0; C];
    }
    let Some(seen) = seen_from(corners, source, receiver) else {
        return [1.0; C];
    };
    let first = split.first as usize;
    let mean = shooter.unshot[slot as usize];
    std::array::from_fn(|c| {
        if mean[c] <= 0.0 {
            return 1.0;
        }
        let part = |k: usize| f64::from(shooter.unshot[first + k][c]);
        let middle = (part(0) + part(1) + part(2)) / 3.0;
        let more: f64 = (0..3)
            .map(|k| f64::from(seen[k]) * (part(k) - middle))
            .sum();
        (1.0 + more / f64::from(mean[c])).clamp(LEAST, MOST)
    })
}

/// The same of a flat cluster of this mean radiosity and its first moment ([`Radiosity::node_moment`]), far enough away for
/// the view of it to change little: the kernel `q h / |d|^4` gains `n_r / h - 4 d / |d|^2` of itself along each axis of the
/// source's plane, `h = n_r . d`.
///
/// [`Radiosity::node_moment`]: super::radiosity::Radiosity::node_moment
pub(super) fn cluster_towards<const C: usize>(
    mean: &[f64; C],
    moment: &[Vec3; C],
    source: &Element,
    receiver: &Element,
) -> [f64; C] {
    let d = source.centroid - receiver.centroid;
    let h = receiver.normal.dot(d);
    let mut gain = d * (-4.0 / d.length_squared());
    if h > 0.0 {
        gain += receiver.normal / h;
    }
    std::array::from_fn(|c| match mean[c] > 0.0 {
        true => (1.0 + f64::from(gain.dot(moment[c])) / mean[c]).clamp(LEAST, MOST),
        false => 1.0,
    })
}

/// A linear function that is nowhere below zero has between half and twice its mean at the centres of the parts, and so
/// at any mean of them.
const LEAST: f64 = 0.5;
const MOST: f64 = 2.0;

/// How much of what a receiver sees of an evenly lit source lies about each of its corners, in all 1; `None` where it sees
/// none. The centres of three of the four children make the degree-2 rule of a triangle.
fn seen_from(corners: [Vec3; 3], source: &Element, receiver: &Element) -> Option<[f32; 3]> {
    let parts = three_points(corners);
    let mut seen = [0.0f32; 3];
    let mut look = |at: Vec3| {
        for (seen, part) in seen.iter_mut().zip(parts) {
            let d = at - part;
            let leaving = source.normal.dot(d).max(0.0);
            let arriving = match receiver.shape {
                Shape::Triangle(_) => (-receiver.normal.dot(d)).max(0.0),
                _ => d.length(),
            };
            let distance2 = d.length_squared();
            *seen += leaving * arriving / (distance2 * distance2).max(f32::MIN_POSITIVE);
        }
    };
    match receiver.shape {
        Shape::Triangle(of) if source.bounds.distance(receiver.bounds) < NEAR * receiver.radius => {
            three_points(of).into_iter().for_each(&mut look);
        }
        _ => look(receiver.centroid),
    }
    let sum: f32 = seen.iter().sum();
    (sum > 0.0 && sum.is_finite()).then(|| seen.map(|x| x / sum))
}

#[cfg(test)]
mod tests {
    use super::super::fixture::{add_plate, grey, prepare, scene};
    use super::super::patch_split::PatchSplit;
    use super::*;
    use crate::math::NodeId;

    /// A triangle in the floor, and one somewhere above it or on a wall.
    fn ends(corner: Vec3, u: Vec3, v: Vec3) -> [Element; 2] {
        let mut s = scene(vec![grey(0.5, 1.0)]);
        add_plate(&mut s, Vec3::ZERO, Vec3::X * 0.4, Vec3::Y * 0.4, 1, 0);
        add_plate(&mut s, corner, u, v, 1, 0);
        let prepared = prepare(&s);
        let leaf_of = |polygon: u32| {
            let nodes = 0..prepared.hierarchy.nodes.len();
            let element =
                |n| Element::of_node(&prepared.scene, &prepared.hierarchy, NodeId::new(n));
            nodes
                .map(element)
                .find(|e| {
                    e.is_triangle()
                        && prepared.hierarchy.facets[e.first_facet as usize].polygon.0 == polygon
                })
                .expect("every polygon has a leaf")
        };
        [leaf_of(0), leaf_of(2)]
    }

    /// A shooter whose one facet's radiosity is linear, with these values at its corners.
    fn linear(corners: [f32; 3]) -> Shooter<1> {
        let mean = corners.iter().sum::<f32>() / 3.0;
        let [a, b, c] = corners.map(|x| [mean + 0.5 * (x - mean)]);
        let parts = [a, b, c, [mean]];
        let leaf = PatchSplit::default();
        Shooter {
            splits: vec![PatchSplit::new(1, parts, [0.0; 4]), leaf, leaf, leaf, leaf],
            unshot: [[mean]].into_iter().chain(parts).collect(),
        }
    }

    /// Centres of small equal parts of a triangle, with their places between its corners.
    fn cells([a, b, c]: [Vec3; 3], count: u32) -> Vec<(Vec3, [f32; 3])> {
        let mut cells = Vec::new();
        for i in 0..count {
            for j in 0..count - i {
                for turned in [false, true] {
                    if turned && i + j + 1 >= count {
                        continue;
                    }
                    let third = if turned { 2.0 / 3.0 } else { 1.0 / 3.0 };
                    let (s, t) = (i as f32 + third, j as f32 + third);
                    let (s, t) = (s / count as f32, t / count as f32);
                    let r = 1.0 - s - t;
                    cells.push((a * r + b * s + c * t, [r, s, t]));
                }
            }
        }
        cells
    }

    #[test]
    fn a_linear_source_sends_what_its_parts_send() {
        let radiosity = [1.0, 4.0, 2.0];
        let shooter = linear(radiosity);
        let mean = 7.0 / 3.0;
        let (mut off_before, mut off) = (0.0f32, 0.0f32);
        for (corner, u, v) in [
            // Walls on the floor's two edges, one a little higher, a lid, and far away.
            (Vec3::new(0.0, 0.0, 0.1), Vec3::Y * 0.4, Vec3::Z * 0.4),
            (Vec3::new(0.0, 0.4, 0.1), Vec3::X * 0.4, Vec3::Z * 0.3),
            (Vec3::new(0.4, 0.0, 0.3), Vec3::Z * 0.2, Vec3::Y * 0.2),
            (Vec3::new(0.0, 0.0, 0.4), Vec3::Y * 0.4, Vec3::X * 0.4),
            (Vec3::new(2.0, 0.0, 1.0), Vec3::Z * 0.2, Vec3::Y * 0.2),
        ] {
            let [source, receiver] = ends(corner, u, v);
            let (Shape::Triangle(from), Shape::Triangle(to)) = (source.shape, receiver.shape)
            else {
                panic!("leaves are triangles");
            };
            let (mut sent, mut even) = (0.0, 0.0);
            for (x, [r, s, t]) in cells(from, 24) {
                for (y, _) in cells(to, 8) {
                    let d = y - x;
                    let kernel = source.normal.dot(d).max(0.0) * (-receiver.normal.dot(d)).max(0.0)
                        / d.length_squared().powi(2);
                    sent += kernel * (r * radiosity[0] + s * radiosity[1] + t * radiosity[2]);
                    even += kernel * mean;
                }
            }
            let exact = sent / even;
            let [factor] = triangle_towards(&shooter, 0, (&source, from), &receiver);
            assert!(even > 0.0 && (exact - 1.0).abs() < 0.5, "{corner}: {exact}");
            off_before += (exact - 1.0).abs();
            off += (exact - factor as f32).abs();
            assert!(
                (exact - factor as f32).abs() < 0.02,
                "{corner}: {factor} for {exact}"
            );
        }
        assert!(
            off_before > 0.2 && off < 0.1 * off_before,
            "{off} of {off_before}"
        );
    }

    #[test]
    fn an_even_source_and_a_leaf_send_their_mean() {
        let [source, receiver] = ends(Vec3::new(0.0, 0.0, 0.1), Vec3::Y * 0.4, Vec3::Z * 0.4);
        let Shape::Triangle(corners) = source.shape else {
            panic!("leaves are triangles");
        };
        for (corner, slot) in [([2.0; 3], 0), ([1.0, 4.0, 2.0], 1)] {
            let sent = triangle_towards(&linear(corner), slot, (&source, corners), &receiver);
            assert_eq!(sent, [1.0]);
        }
    }
}
