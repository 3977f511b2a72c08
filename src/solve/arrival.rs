//! What arrives at a receiver: irradiance vectors ([`super::element_vector`]) at points of it, fitted by what
//! a receiver of its kind can hold.

use super::cluster_light::ClusterLight;
use super::composite_rule::{CompositeRule, MOST_POINTS, three_points};
use super::element::{Element, Shape};
use super::element_vector::{Space, element_vector};
use super::irradiance_kernel::{Shining, irradiance_on};
use super::push_pull::local_children;
use super::receiver_spread::spread_over;
use crate::math::NodeId;
use crate::visibility::PARTS;
use glam::Vec3;

/// Levels below a receiving cluster whose centroids are its points, and the gap in its radii from which they serve:
/// two from 4 radii on instead of eight leave the error of a solve the same (`bench/runs/`, accuracy).
const POINTS_OF_A_CLUSTER: [(f32, u32); 3] = [(10.0, 0), (4.0, 1), (0.0, MOST_LEVELS)];
/// Most levels below a receiving cluster: as many nodes as there are parts whose visibility is told apart.
const MOST_LEVELS: u32 = PARTS.ilog2();

/// The irradiance from a unit-radiosity source over a receiver, unoccluded.
#[allow(clippy::large_enum_variant, reason = "an exchange allocates nothing")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Arrival {
    /// On a triangle: the linear function that fits best, by its values at the three corners.
    Linear([f32; 3]),
    /// On a flat cluster: irradiance vectors of nodes of it, to be dotted with each facet's normal, with their slopes.
    Vectors(NodeVectors),
}

/// Irradiance vectors of nodes that make up a cluster.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NodeVectors {
    count: usize,
    vectors: [(u32, Vec3); PARTS],
    /// Where the vectors are those, and what the irradiance gains along each axis from there.
    slopes: [(Vec3, Vec3); PARTS],
    /// First facets of the nodes.
    first_facets: [u32; PARTS],
}

impl NodeVectors {
    const NONE: Self = Self {
        count: 0,
        vectors: [(0, Vec3::ZERO); PARTS],
        slopes: [(Vec3::ZERO, Vec3::ZERO); PARTS],
        first_facets: [0; PARTS],
    };

    fn push(&mut self, local: usize, first_facet: u32, vector: Vec3, slope: (Vec3, Vec3)) {
        self.first_facets[self.count] = first_facet;
        self.vectors[self.count] = (local as u32, vector);
        self.slopes[self.count] = slope;
        self.count += 1;
    }

    /// Places in the owner's depth-first order of nodes, and the light there.
    pub fn lights(&self) -> impl Iterator<Item = (usize, ClusterLight)> + '_ {
        let nodes = self.vectors[..self.count].iter().zip(&self.slopes);
        nodes.map(|(&(local, vector), &(centroid, slope))| {
            (local as usize, ClusterLight::about(centroid, vector, slope))
        })
    }
}

impl Arrival {
    /// First facets of all parts of a cluster but the first of which the light is told apart.
    pub fn parts(&self) -> &[u32] {
        match self {
            Self::Linear(_) => &[],
            Self::Vectors(nodes) => &nodes.first_facets[1..nodes.count.max(1)],
        }
    }

    /// True when nothing arrives.
    pub fn is_zero(&self) -> bool {
        match self {
            Self::Linear(e) => *e == [0.0; 3],
            Self::Vectors(nodes) => {
                let mut vectors = nodes.vectors[..nodes.count].iter();
                vectors.all(|&(_, vector)| vector == Vec3::ZERO)
            }
        }
    }
}

/// What arrives at `receiver` from `source` of unit radiosity, V = 1, and how far it strays from that
/// linear function at the points where it was evaluated.
///
/// The number of receiver points grows towards contact, by the gap between the boxes over the
/// receiver's radius: 1, 3, 12 or 48 points. Form factors at contact are thereby integrated and
/// not guessed from the centres.
pub fn arrival(space: &Space, source: &Element, receiver: &Element, local: u32) -> (Arrival, f32) {
    let gap = source.bounds.distance(receiver.bounds);
    match receiver.shape {
        Shape::Triangle(corners) => {
            if gap > 10.0 * receiver.radius && !nears_horizon(source, receiver) {
                let n = receiver.normal;
                let at = receiver.centroid;
                let vector = element_vector(space, source, at, Some(n));
                return (Arrival::Linear([n.dot(vector).max(0.0); 3]), 0.0);
            }
            let rule = CompositeRule::on_parts(splits_at(gap, receiver.radius));
            let mut values = [[0.0f32; 8]; MOST_POINTS / 8];
            let values = &mut values[..rule.octets.len()];
            irradiance_at(space, source, receiver, corners, rule, values);
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
        Shape::Cluster => {
            let levels = POINTS_OF_A_CLUSTER
                .iter()
                .find(|(radii, _)| gap > radii * receiver.radius)
                .map_or(MOST_LEVELS, |&(_, levels)| levels);
            let mut nodes = NodeVectors::NONE;
            let place = (receiver.node, local as usize);
            node_vectors(space, source, place, levels, &mut nodes);
            (Arrival::Vectors(nodes), 0.0)
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
    // Lanes past the last point are never looked at.
    let points = rule.looked_at();
    for (at, (octet, values)) in rule.octets.iter().zip(values).enumerate() {
        for (l, value) in values.iter_mut().enumerate().take(points - 8 * at) {
            let [a, b, c] = corners;
            let p = a * octet[0][l] + b * octet[1][l] + c * octet[2][l];
            *value = n.dot(element_vector(space, source, p, Some(n))).max(0.0);
        }
    }
}

/// Irradiance vectors of the nodes `levels` below a receiving cluster.
fn node_vectors(
    space: &Space,
    source: &Element,
    (receiver, local): (NodeId, usize),
    levels: u32,
    nodes: &mut NodeVectors,
) {
    let shape = space.hierarchy.shape(receiver);
    let at = |p: Vec3| element_vector(space, source, p, None);
    match space.hierarchy.children(receiver) {
        _ if levels == 0 => {
            let vector = at(shape.centroid);
            let mean_square = space.flux_tree.mean_square(receiver);
            let (mean, slope) = spread_over(shape, mean_square, source, vector);
            let first = space.hierarchy.node(receiver).first_facet;
            nodes.push(local, first, vector * mean, (shape.centroid, slope));
        }
        None => {
            let facet = space.hierarchy.facets[space.hierarchy.facet_of_leaf(receiver).index()];
            let points = three_points(space.scene.facet_corners(facet));
            let first = space.hierarchy.node(receiver).first_facet;
            let vector = points.into_iter().map(at).sum::<Vec3>() / 3.0;
            nodes.push(local, first, vector, (shape.centroid, Vec3::ZERO));
        }
        Some(children) => {
            let locals = local_children(space.hierarchy, children[0], local);
            for place in children.into_iter().zip(locals) {
                node_vectors(space, source, place, levels - 1, nodes);
            }
        }
    }
}
