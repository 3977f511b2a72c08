//! Irradiance that a uniformly radiant source of unit radiosity casts on a point: form factors from
//! a differential receiver.
//!
//! Near triangles use the exact contour integral (Lambert; truth: 1/(2 pi) sum of theta_i (n . gamma_i)
//! after clipping to the receiver's horizon). Far ones use a quadrature of the kernel
//! cos cos / (pi r^2). Everything is a *vector* K with irradiance n . K, so that one evaluation
//! serves every normal of a receiving cluster that has the source wholly in front.

use super::composite_rule::{CompositeRule, MOST_POINTS, three_points};
use super::element::{Element, Shape};
use super::irradiance_kernel::{CONTOUR_RADII, POINT_RADII, Shining, irradiance_on};
use crate::cluster::Hierarchy;
use crate::math::NodeId;
use crate::scene::Scene;
use glam::Vec3;
use std::f32::consts::{FRAC_1_PI, PI};

/// A cluster is taken as one flux vector beyond this many radii (its radius bounds its box, about
/// twice its radius of gyration, so the error is below (1/16)^2 = 4e-3), else as its two children. Between 6 and 12
/// the error of a solve does not change; 12 makes pass 2 of c a sixth slower than 6 (`bench/runs/`, accuracy).
const CLUSTER_RADII: f32 = 8.0;
/// Levels below a receiving cluster whose centroids are its points, and the gap in its radii from which they serve:
/// two from 4 radii on instead of eight leave the error of a solve the same (`bench/runs/`, accuracy).
const POINTS_OF_A_CLUSTER: [(f32, u32); 3] = [(10.0, 0), (4.0, 1), (0.0, 3)];

/// The vector K of a unit-radiosity triangle at `point`, clipped to the horizon of `normal` where
/// that is given. Zero where the point lies behind the triangle or within `tau` of its plane.
pub fn triangle_vector(
    corners: [Vec3; 3],
    source_normal: Vec3,
    area: f32,
    point: Vec3,
    normal: Option<Vec3>,
    tau: f32,
) -> Vec3 {
    let rel = corners.map(|c| c - point);
    // Height of the point over the source's plane; behind it, and within tau of it, there is no light:
    // the other side of the same sheet lies there.
    let height = -source_normal.dot(rel[0]);
    if height <= tau {
        return Vec3::ZERO;
    }
    if let Some(n) = normal {
        let h = rel.map(|r| n.dot(r));
        let low = h[0].min(h[1]).min(h[2]);
        if low < 0.0 {
            if h[0].max(h[1]).max(h[2]) <= 0.0 {
                return Vec3::ZERO;
            }
            return contour_clipped(rel, h);
        }
    }
    let centroid = (rel[0] + rel[1] + rel[2]) * (1.0 / 3.0);
    let radius2 = rel
        .iter()
        .fold(0.0f32, |m, r| m.max((*r - centroid).length_squared()));
    let distance2 = centroid.length_squared();
    if distance2 > POINT_RADII * POINT_RADII * radius2 {
        let inverse = 1.0 / distance2;
        return centroid * (area * height * inverse * inverse * FRAC_1_PI);
    }
    if distance2 > CONTOUR_RADII * CONTOUR_RADII * radius2 {
        // The degree-2 rule at the three midpoints between the centroid and the corners.
        let mut sum = Vec3::ZERO;
        for r in rel {
            let q = (centroid + r) * 0.5;
            let inverse = 1.0 / q.length_squared();
            sum += q * (inverse * inverse);
        }
        return sum * (area * height * (FRAC_1_PI / 3.0));
    }
    contour(&rel)
}

/// Lambert's contour integral over a polygon given relative to the receiving point,
/// counter-clockwise seen from the point's side of it.
fn contour(rel: &[Vec3]) -> Vec3 {
    let mut sum = Vec3::ZERO;
    let mut previous = rel[rel.len() - 1];
    for &next in rel {
        let cross = next.cross(previous);
        let sine = cross.length();
        // An edge that passes through the point, or of no length, subtends nothing.
        if sine > 0.0 {
            let theta = sine.atan2(previous.dot(next));
            sum += cross * (theta / sine);
        }
        previous = next;
    }
    // Counter-clockwise seen from the point, next x previous turns gamma towards the polygon.
    sum * (0.5 * FRAC_1_PI)
}

/// The contour integral of the part of a triangle above the horizon (`h >= 0`).
fn contour_clipped(rel: [Vec3; 3], h: [f32; 3]) -> Vec3 {
    let mut clipped = [Vec3::ZERO; 4];
    let mut count = 0;
    for i in 0..3 {
        let j = (i + 1) % 3;
        if h[i] >= 0.0 {
            clipped[count] = rel[i];
            count += 1;
        }
        if (h[i] >= 0.0) != (h[j] >= 0.0) {
            let t = h[i] / (h[i] - h[j]);
            clipped[count] = rel[i] + (rel[j] - rel[i]) * t;
            count += 1;
        }
    }
    contour(&clipped[..count])
}

/// Where elements stand.
#[derive(Clone, Copy)]
pub struct Space<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Its hierarchy.
    pub hierarchy: &'a Hierarchy,
    /// The element of each node.
    pub elements: &'a [Element],
    /// Unit normal of each facet.
    pub normals: &'a [Vec3],
    /// Sums of the sources' power before each facet, and of all.
    pub power_before: &'a [f64],
    /// Depth below a surface within which nothing counts, normalised.
    pub tau: f32,
}

/// Whether one vector stands for the normals of each end (always for triangles); where not, every
/// facet is asked.
#[derive(Clone, Copy)]
pub struct Flatness {
    /// Of the source.
    pub source: bool,
    /// Of the receiver.
    pub receiver: bool,
}

/// The vector K of a unit-radiosity element at a point. A cluster must face the point fully.
fn element_vector(
    space: &Space,
    source: &Element,
    point: Vec3,
    normal: Option<Vec3>,
    flat: bool,
) -> Vec3 {
    match source.shape {
        Shape::Triangle(corners) => triangle_vector(
            corners,
            source.normal,
            source.area,
            point,
            normal,
            space.tau,
        ),
        Shape::Cluster if flat => cluster_vector(space, source.node, point, normal),
        Shape::Cluster => wide_vector(space, source, point, normal),
        Shape::Volume => Vec3::ZERO,
    }
}

/// The vector K of a cluster of any shape and mean radiosity 1, seen from far away: every facet that faces the point
/// counts by its power, as if it stood at the centroid, since lamps seldom shine the way their housings face. What hides behind other facets is left to visibility.
fn wide_vector(space: &Space, source: &Element, point: Vec3, normal: Option<Vec3>) -> Vec3 {
    let rel = source.centroid - point;
    if normal.is_some_and(|n| n.dot(rel) <= 0.0) {
        return Vec3::ZERO;
    }
    let inverse = 1.0 / rel.length_squared();
    let range = source.facet_range();
    let whole = space.power_before[range.end] - space.power_before[range.start];
    let mut flux = 0.0f32;
    for facet in range {
        let power = space.power_before[facet + 1] - space.power_before[facet];
        // The area that would send as much at the cluster's mean radiosity.
        let area = source.area * (power / whole) as f32;
        flux += area * (-space.normals[facet].dot(rel)).max(0.0);
    }
    rel * (flux * inverse * inverse * FRAC_1_PI)
}

fn cluster_vector(space: &Space, id: NodeId, point: Vec3, normal: Option<Vec3>) -> Vec3 {
    let Some(children) = space.hierarchy.children(id) else {
        let leaf = &space.elements[id.index()];
        return element_vector(space, leaf, point, normal, true);
    };
    let node = space.hierarchy.node(id);
    let shape = space.hierarchy.shape(id);
    let rel = shape.centroid - point;
    let distance2 = rel.length_squared();
    let half = (node.bounds.max - node.bounds.min) * 0.5;
    if distance2 > CLUSTER_RADII * CLUSTER_RADII * half.length_squared() {
        let flux = (-shape.area_vector.dot(rel)).max(0.0);
        let inverse = 1.0 / distance2;
        let above = normal.is_none_or(|n| n.dot(rel) > 0.0);
        return if above {
            rel * (flux * inverse * inverse * FRAC_1_PI)
        } else {
            Vec3::ZERO
        };
    }
    children
        .into_iter()
        .map(|child| cluster_vector(space, child, point, normal))
        .sum()
}

/// The irradiance from a unit-radiosity source over a receiver, unoccluded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Arrival {
    /// On a triangle: the linear function that fits best, by its values at the three corners.
    Linear([f32; 3]),
    /// On a flat cluster: the mean irradiance vector, to be dotted with each facet's normal.
    Vector(Vec3),
    /// On a cluster of any shape: the irradiance vector at its centroid, whose dot product with each
    /// facet's normal counts where it is positive.
    Field(Vec3),
}

impl Arrival {
    /// True when nothing arrives.
    pub fn is_zero(&self) -> bool {
        match *self {
            Self::Linear(e) => e == [0.0; 3],
            Self::Vector(v) | Self::Field(v) => v == Vec3::ZERO,
        }
    }
}

/// What arrives at `receiver` from `source` of unit radiosity, V = 1, and how far it strays from that
/// linear function at the points where it was evaluated.
///
/// The number of receiver points grows towards contact, by the gap between the boxes over the
/// receiver's radius: 1, 3, 12 or 48 points. Form factors at contact are thereby integrated and
/// not guessed from the centres.
pub fn arrival(
    space: &Space,
    source: &Element,
    receiver: &Element,
    flatness: Flatness,
) -> (Arrival, f32) {
    let gap = source.bounds.distance(receiver.bounds);
    match receiver.shape {
        Shape::Triangle(corners) => {
            if gap > 10.0 * receiver.radius && !nears_horizon(source, receiver) {
                let n = receiver.normal;
                let at = receiver.centroid;
                let vector = element_vector(space, source, at, Some(n), flatness.source);
                return (Arrival::Linear([n.dot(vector).max(0.0); 3]), 0.0);
            }
            let rule = CompositeRule::on_parts(splits_at(gap, receiver.radius));
            let mut values = [[0.0f32; 8]; MOST_POINTS / 8];
            let values = &mut values[..rule.octets.len()];
            irradiance_at(
                space,
                source,
                receiver,
                corners,
                flatness.source,
                rule,
                values,
            );
            let moments = rule.moments(values);
            // Least squares over the linear functions: the mass matrix of a triangle is
            // area/12 (I + 1 1^T), its inverse 12/area (I - 1 1^T / 4).
            let mean = moments.x + moments.y + moments.z;
            let fit = 12.0 * moments - Vec3::splat(3.0 * mean);
            // A source much smaller than its receiver, and near it, lights a spot that the receiver's points
            // may miss or hit too often: the mean is then taken from the source's side.
            let spot = match source.shape {
                Shape::Triangle(from) if source.area < SPOT_AREA * receiver.area => {
                    Some(spot_mean(source, from, receiver, corners, gap, space.tau))
                }
                _ => None,
            };
            if mean <= 0.0 {
                // Every point of the receiver may have missed the spot.
                let spot = spot.unwrap_or(0.0);
                return (Arrival::Linear([spot; 3]), spot);
            }
            let residual = if rule.count == 3 {
                // Three points always lie on a linear function: ask the centroid, a fourth.
                (values[0][3] - mean).abs()
            } else {
                rule.residual(values, fit)
            };
            let scale = spot.map_or(1.0, |spot| spot / mean);
            (Arrival::Linear((fit * scale).to_array()), residual)
        }
        Shape::Cluster if !flatness.receiver => {
            let at = receiver.centroid;
            let vector = element_vector(space, source, at, None, flatness.source);
            (Arrival::Field(vector), 0.0)
        }
        Shape::Cluster => {
            let levels = POINTS_OF_A_CLUSTER
                .iter()
                .find(|(radii, _)| gap > radii * receiver.radius)
                .map_or(3, |&(_, levels)| levels);
            let sum = cluster_mean(space, source, receiver.node, levels, flatness.source);
            (Arrival::Vector(sum / receiver.area), 0.0)
        }
        Shape::Volume => (Arrival::Linear([0.0; 3]), 0.0),
    }
}

/// True where a receiver comes so near to the plane of its source that the light varies over it however far it is.
fn nears_horizon(source: &Element, receiver: &Element) -> bool {
    let height = source.normal.dot(receiver.centroid - source.centroid);
    height < HORIZON_RADII * receiver.radius
}

/// Height over the source's plane, in radii of the receiver, from which its light varies by less than a quarter to
/// either side (`bench/runs/`, accuracy/horizon.md).
const HORIZON_RADII: f32 = 4.0;

/// Receiver points of a composite rule stand about a sixth of its size apart at contact, so a source of less
/// than this share of its area may fall between them.
const SPOT_AREA: f32 = 0.25;

/// Mean irradiance of a receiver from a smaller source of unit radiosity, by reciprocity: A_r F_rs = A_s F_sr,
/// with F_sr averaged over points of the source.
fn spot_mean(
    source: &Element,
    source_corners: [Vec3; 3],
    receiver: &Element,
    receiver_corners: [Vec3; 3],
    gap: f32,
    tau: f32,
) -> f32 {
    let rule = CompositeRule::on_parts(splits_at(gap, source.radius));
    let mut values = [[0.0f32; 8]; MOST_POINTS / 8];
    let values = &mut values[..rule.octets.len()];
    let shining = Shining {
        corners: receiver_corners,
        normal: receiver.normal,
        area: receiver.area,
    };
    irradiance_on(
        &shining,
        source_corners,
        source.normal,
        tau,
        &rule.octets,
        values,
    );
    let moments = rule.moments(values);
    (moments.x + moments.y + moments.z) * source.area / receiver.area
}

/// How often the receiver is split for its points: the nearer, in its radii, the more often.
fn splits_at(gap: f32, radius: f32) -> usize {
    if gap > 1.5 * radius {
        0
    } else if gap > 0.25 * radius {
        1
    } else {
        2
    }
}

/// Irradiance from a unit-radiosity source at the points of a rule on a triangle.
fn irradiance_at(
    space: &Space,
    source: &Element,
    receiver: &Element,
    corners: [Vec3; 3],
    flat: bool,
    rule: &CompositeRule,
    values: &mut [[f32; 8]],
) {
    let n = receiver.normal;
    if let Shape::Triangle(from) = source.shape {
        let shining = Shining {
            corners: from,
            normal: source.normal,
            area: source.area,
        };
        return irradiance_on(&shining, corners, n, space.tau, &rule.octets, values);
    }
    for (octet, values) in rule.octets.iter().zip(values) {
        for (l, value) in values.iter_mut().enumerate() {
            let [a, b, c] = corners;
            let p = a * octet[0][l] + b * octet[1][l] + c * octet[2][l];
            *value = n
                .dot(element_vector(space, source, p, Some(n), flat))
                .max(0.0);
        }
    }
}

/// Area times mean irradiance vector of a receiving cluster, from the nodes `levels` below.
fn cluster_mean(
    space: &Space,
    source: &Element,
    receiver: NodeId,
    levels: u32,
    flat: bool,
) -> Vec3 {
    let shape = space.hierarchy.shape(receiver);
    let at = |p: Vec3| element_vector(space, source, p, None, flat);
    match space.hierarchy.children(receiver) {
        _ if levels == 0 => at(shape.centroid) * shape.area,
        None => {
            let facet = space.hierarchy.facets[space.hierarchy.facet_of_leaf(receiver).index()];
            let points = three_points(space.scene.facet_corners(facet));
            points.into_iter().map(at).sum::<Vec3>() * (shape.area / 3.0)
        }
        Some(children) => children
            .into_iter()
            .map(|child| cluster_mean(space, source, child, levels - 1, flat))
            .sum(),
    }
}

/// An estimate from above of the form factor source -> receiver for the oracle: the point kernel with
/// each cosine raised by the angular radius of the other end, which a zero at the centres cannot hide.
pub fn oracle_form_factor(source: &Element, receiver: &Element) -> f32 {
    let d = receiver.centroid - source.centroid;
    let distance2 = d.length_squared();
    if distance2 <= 0.0 {
        return 1.0;
    }
    let inverse = 1.0 / distance2.sqrt();
    let spread = (source.radius + receiver.radius) * inverse;
    let cos_source = (source.normal.dot(d) * inverse).max(0.0) + spread + source.cone_sin;
    let cos_receiver = (-receiver.normal.dot(d) * inverse).max(0.0) + spread + receiver.cone_sin;
    let f = receiver.area * cos_source.min(1.0) * cos_receiver.min(1.0)
        / (PI * distance2 + receiver.area);
    f.min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Irradiance of a unit-radiosity rectangle `corners` (counter-clockwise seen from the light's
    /// side) on a point.
    fn rectangle(corners: [Vec3; 4], point: Vec3, normal: Vec3) -> f32 {
        let [a, b, c, d] = corners;
        [[a, b, c], [a, c, d]]
            .into_iter()
            .map(|t| {
                let cross = (t[1] - t[0]).cross(t[2] - t[0]);
                let k = triangle_vector(
                    t,
                    cross.normalize(),
                    0.5 * cross.length(),
                    point,
                    Some(normal),
                    0.0,
                );
                normal.dot(k)
            })
            .sum()
    }

    /// Point to a parallel rectangle a x b at distance c, one corner on the point's normal.
    fn parallel(a: f64, b: f64, c: f64) -> f64 {
        let (a, b) = (a / c, b / c);
        let (ra, rb) = ((1.0 + a * a).sqrt(), (1.0 + b * b).sqrt());
        (a / ra * (b / ra).atan() + b / rb * (a / rb).atan()) / (2.0 * std::f64::consts::PI)
    }

    /// Point to a perpendicular rectangle of width a and height b, its lower corner at distance c.
    fn perpendicular(a: f64, b: f64, c: f64) -> f64 {
        let r = (b * b + c * c).sqrt();
        ((a / c).atan() - c / r * (a / r).atan()) / (2.0 * std::f64::consts::PI)
    }

    fn above(a: f32, b: f32, c: f32) -> [Vec3; 4] {
        [
            Vec3::new(0.0, 0.0, c),
            Vec3::new(0.0, b, c),
            Vec3::new(a, b, c),
            Vec3::new(a, 0.0, c),
        ]
    }

    #[test]
    fn parallel_rectangle_matches_its_closed_form_at_any_distance() {
        // From contact to the far rules: relative error of each against the closed form.
        for c in [
            0.01f32, 0.1, 0.5, 1.0, 3.0, 6.0, 9.0, 15.0, 25.0, 45.0, 100.0,
        ] {
            for (a, b) in [(1.0f32, 1.0), (0.5, 2.0)] {
                let got = rectangle(above(a, b, c), Vec3::ZERO, Vec3::Z);
                let want = parallel(f64::from(a), f64::from(b), f64::from(c));
                let error = (f64::from(got) - want).abs() / want;
                assert!(error < 1.0e-3, "a {a} b {b} c {c}: {got} for {want}");
            }
        }
    }

    #[test]
    fn perpendicular_rectangle_matches_its_closed_form() {
        for c in [0.01f32, 0.1, 1.0, 5.0] {
            let corners = [
                Vec3::new(c, 0.0, 0.0),
                Vec3::new(c, 1.0, 0.0),
                Vec3::new(c, 1.0, 1.0),
                Vec3::new(c, 0.0, 1.0),
            ]
            .map(|v| Vec3::new(v.x, v.y, v.z));
            // Seen from -x: counter-clockwise is y then z reversed.
            let corners = [corners[0], corners[3], corners[2], corners[1]];
            let got = rectangle(corners, Vec3::ZERO, Vec3::Z);
            let want = perpendicular(1.0, 1.0, f64::from(c));
            assert!(
                (f64::from(got) - want).abs() < 1.0e-4 * want.max(0.01),
                "c {c}: {got} for {want}"
            );
        }
    }

    #[test]
    fn a_rectangle_below_the_horizon_gives_nothing_and_one_across_it_half() {
        let below = above(1.0, 1.0, -1.0);
        let flipped = [below[0], below[3], below[2], below[1]];
        assert_eq!(rectangle(flipped, Vec3::ZERO, Vec3::Z), 0.0);
        // A wall at x = 1 from z = -1 to 1 gives what its upper half gives.
        let wall = |low: f32| {
            [
                Vec3::new(1.0, 0.0, low),
                Vec3::new(1.0, 0.0, 1.0),
                Vec3::new(1.0, 1.0, 1.0),
                Vec3::new(1.0, 1.0, low),
            ]
        };
        let (whole, half) = (
            rectangle(wall(-1.0), Vec3::ZERO, Vec3::Z),
            rectangle(wall(0.0), Vec3::ZERO, Vec3::Z),
        );
        assert!(half > 0.05);
        assert!((whole - half).abs() < 1.0e-6, "{whole} for {half}");
    }

    #[test]
    fn the_back_of_a_source_is_dark() {
        let [a, b, c, d] = above(1.0, 1.0, 1.0);
        assert_eq!(rectangle([d, c, b, a], Vec3::ZERO, Vec3::Z), 0.0);
    }

    #[test]
    fn the_six_walls_of_a_cube_fill_every_points_sky() {
        // Closure: the irradiance vectors of a closed convex room, with unit radiosity, sum to 1
        // about any normal.
        let lo = Vec3::splat(-0.5);
        let hi = Vec3::splat(0.5);
        let mut walls = Vec::new();
        for axis in 0..3 {
            for (sign, at) in [(1.0f32, lo[axis]), (-1.0, hi[axis])] {
                let mut u = Vec3::ZERO;
                let mut v = Vec3::ZERO;
                u[(axis + 1) % 3] = 1.0;
                v[(axis + 2) % 3] = sign;
                let mut corner = lo;
                corner[axis] = at;
                if sign < 0.0 {
                    corner[(axis + 2) % 3] = hi[(axis + 2) % 3];
                }
                walls.push([corner, corner + u, corner + u + v, corner + v]);
            }
        }
        for (point, normal) in [
            (
                Vec3::new(0.1, -0.2, 0.3),
                Vec3::new(0.3, 0.5, -0.8).normalize(),
            ),
            (Vec3::new(-0.499, 0.499, -0.499), Vec3::Z),
            (
                Vec3::new(0.0, 0.45, 0.2),
                Vec3::new(-1.0, 0.02, 0.1).normalize(),
            ),
        ] {
            let sum: f32 = walls.iter().map(|&w| rectangle(w, point, normal)).sum();
            assert!((sum - 1.0).abs() < 1.0e-5, "{point} {normal}: {sum}");
        }
    }
}
