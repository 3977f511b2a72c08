//! An upper bound of the form factor between two elements of any shape, from their spheres and cones of normals.

use super::element::Element;

/// The greatest share of what the source sends out evenly that the receiver can take, from 0 to 1. It is what is
/// left of the light where nothing stands in the way and no part of an end hides another. `gap` is the distance of
/// their boxes.
pub fn form_factor_bound(source: &Element, receiver: &Element, gap: f32) -> f32 {
    let there = bound_into_sphere(source, receiver, gap);
    // Reciprocity: A_s F_sr = A_r F_rs.
    let back = bound_into_sphere(receiver, source, gap) * (receiver.area / source.area);
    there.min(back).min(1.0)
}

/// From no point can a sphere of radius r at distance D take more than (r/D)^2 of the light, and no more than its
/// solid angle, 2 pi (1 - sqrt(1 - (r/D)^2)), over pi at the greatest cosine with which the light leaves.
fn bound_into_sphere(from: &Element, to: &Element, gap: f32) -> f32 {
    let distance = (to.centroid - from.centroid).length() - from.radius;
    if distance <= to.radius {
        return 1.0;
    }
    let ratio = to.radius / distance;
    let share = ratio * ratio;
    let cosine = from.greatest_cosine(to, gap);
    share * (2.0 * cosine / (1.0 + (1.0 - share).sqrt())).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::NodeId;
    use crate::solve::fixture::{add_box, add_plate, grey, prepare, scene};
    use crate::solve::prepared::PreparedScene;
    use glam::Vec3;

    /// A lamp, a slanting plate and two blocks.
    fn pieces() -> PreparedScene {
        let mut s = scene(vec![grey(0.5, 1.0)]);
        add_plate(
            &mut s,
            Vec3::new(-0.1, 0.4, -0.1),
            Vec3::X * 0.2,
            Vec3::Z * 0.2,
            2,
            0,
        );
        add_plate(
            &mut s,
            Vec3::new(0.2, -0.4, -0.2),
            Vec3::new(0.1, 0.2, 0.0),
            Vec3::Z * 0.3,
            2,
            0,
        );
        add_box(
            &mut s,
            Vec3::new(-0.4, -0.4, -0.3),
            Vec3::new(-0.2, -0.1, -0.2),
            1,
            [0; 6],
            false,
        );
        add_box(
            &mut s,
            Vec3::new(-0.4, 0.1, 0.2),
            Vec3::new(-0.3, 0.3, 0.4),
            1,
            [0; 6],
            false,
        );
        prepare(&s)
    }

    /// Points and normals spread evenly over an element's facets, with the area that each stands for.
    fn points(prepared: &PreparedScene, element: &Element) -> Vec<(Vec3, Vec3, f32)> {
        const CELLS: u32 = 3;
        let mut points = Vec::new();
        for facet in element.facet_range() {
            let [a, b, c] = prepared
                .scene
                .facet_corners(prepared.hierarchy.facets[facet]);
            let cross = (b - a).cross(c - a);
            let area = 0.5 * cross.length() / (CELLS * CELLS) as f32;
            for i in 0..CELLS {
                for j in 0..CELLS {
                    let [mut u, mut v] = [i, j].map(|k| (k as f32 + 0.4) / CELLS as f32);
                    if u + v > 1.0 {
                        (u, v) = (1.0 - u, 1.0 - v);
                    }
                    points.push((a + (b - a) * u + (c - a) * v, cross.normalize(), area));
                }
            }
        }
        points
    }

    #[test]
    fn no_pair_of_nodes_carries_more_than_the_bound_and_far_ones_not_much_less() {
        let prepared = pieces();
        let elements: Vec<Element> = (0..prepared.hierarchy.nodes.len())
            .map(|n| Element::of_node(&prepared.scene, &prepared.hierarchy, NodeId::new(n)))
            .collect();
        let (mut judged, mut facing_away) = (0, 0);
        for source in &elements {
            for receiver in &elements {
                let gap = source.bounds.distance(receiver.bounds);
                // Nearer, so few points say nothing.
                if source.overlaps(receiver) || gap < source.radius.max(receiver.radius) {
                    continue;
                }
                let (mut power, mut area) = (0.0, 0.0);
                for (x, n, part) in points(&prepared, source) {
                    area += part;
                    for (y, m, piece) in points(&prepared, receiver) {
                        let d = y - x;
                        let cosines = n.dot(d).max(0.0) * (-m.dot(d)).max(0.0);
                        power += part * piece * cosines
                            / (std::f32::consts::PI * d.length_squared() * d.length_squared());
                    }
                }
                let (found, bound) = (power / area, form_factor_bound(source, receiver, gap));
                assert!(
                    found <= bound * 1.02,
                    "{found} over {bound}: {source:?} {receiver:?}"
                );
                judged += u32::from(found > 0.0);
                facing_away += u32::from(bound == 0.0);
            }
        }
        assert!(judged > 100 && facing_away > 10, "{judged} {facing_away}");
    }

    #[test]
    fn a_lamp_sends_the_less_the_lower_over_its_horizon() {
        let prepared = pieces();
        let node = |n| Element::of_node(&prepared.scene, &prepared.hierarchy, NodeId::new(n));
        let lamp = (0..prepared.hierarchy.nodes.len())
            .map(node)
            .find(|e| e.is_triangle() && e.normal.y.abs() > 0.9 && e.centroid.y > 0.39)
            .expect("the lamp");
        let shifted = |by: Vec3| {
            let mut other = lamp;
            other.shape = crate::solve::element::Shape::Volume;
            other.centroid += by;
            other.bounds.min += by;
            other.bounds.max += by;
            other
        };
        let bound = |by| {
            let other = shifted(by);
            form_factor_bound(&lamp, &other, lamp.bounds.distance(other.bounds))
        };
        let ahead = bound(lamp.normal * 2.0);
        let aside = bound(Vec3::X * 2.0 + lamp.normal * 0.1);
        assert!(aside < 0.2 * ahead && aside > 0.0, "{aside} {ahead}");
    }
}
