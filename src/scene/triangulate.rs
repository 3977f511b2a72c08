//! N-gons, convex or not, cut into triangles by ear clipping (the `earcut` crate) in the polygon's
//! best-fit plane.

use earcut::Earcut;
use glam::{DVec2, DVec3};

/// Share of a polygon's area by which its triangles may miss it before it counts as crossing
/// itself: far above rounding (1e-12 for shapes that f32 can hold), far below what shows.
const AREA_TOLERANCE: f64 = 1e-6;

/// Cuts polygons; keeps its buffers from one to the next.
pub(super) struct Triangulator {
    earcut: Earcut<f64>,
    flat: Vec<[f64; 2]>,
    indices: Vec<u32>,
}

/// Triangles of one polygon.
pub(super) struct Triangulation {
    /// Triples of indices into the ring, each turning as the ring does.
    pub triangles: Vec<[u32; 3]>,
    /// True where the triangles do not cover the ring's area: it crosses itself.
    pub crosses_itself: bool,
}

impl Triangulator {
    pub fn new() -> Self {
        Self {
            earcut: Earcut::new(),
            flat: Vec::new(),
            indices: Vec::new(),
        }
    }

    /// The triangles of `ring`, whose consecutive vertices differ. A ring without area, whose
    /// winding therefore means nothing, has none.
    pub fn triangulate(&mut self, ring: &[DVec3]) -> Triangulation {
        let mut triangulation = Triangulation {
            triangles: Vec::with_capacity(ring.len().saturating_sub(2)),
            crosses_itself: false,
        };
        if ring.len() == 3 {
            triangulation.triangles.push([0, 1, 2]);
            return triangulation;
        }
        let normal = area_normal(ring);
        if normal == DVec3::ZERO {
            return triangulation;
        }
        self.flat.clear();
        self.flat.extend(
            ring.iter()
                .map(|&p| project(p - ring[0], normal).to_array()),
        );
        self.earcut
            .earcut_slice::<u32>(&self.flat, &[], &mut self.indices);
        let mut covered = 0.0;
        for &[a, b, c] in self.indices.as_chunks::<3>().0 {
            let doubled = self.doubled_area([a, b, c]);
            covered += doubled.abs();
            // The projection keeps the winding: counter-clockwise where the ring is seen from its
            // front.
            triangulation
                .triangles
                .push(if doubled >= 0.0 { [a, b, c] } else { [a, c, b] });
        }
        let whole = normal.abs().max_element();
        triangulation.crosses_itself = (covered - whole).abs() > AREA_TOLERANCE * whole;
        triangulation
    }

    fn doubled_area(&self, triangle: [u32; 3]) -> f64 {
        let [a, b, c] = triangle.map(|i| DVec2::from(self.flat[i as usize]));
        (b - a).perp_dot(c - a)
    }
}

/// Normal of the best-fit plane (Newell's sum), its length twice the area.
pub(super) fn area_normal(ring: &[DVec3]) -> DVec3 {
    let mut sum = DVec3::ZERO;
    for pair in ring[1..].windows(2) {
        sum += (pair[0] - ring[0]).cross(pair[1] - ring[0]);
    }
    sum
}

/// Drops the coordinate in which the plane is steepest. This is an affine picture of the best-fit
/// plane, mirrored where needed so that the front stays counter-clockwise, and it rounds nothing.
fn project(p: DVec3, normal: DVec3) -> DVec2 {
    let size = normal.abs();
    let (flat, up) = if size.z >= size.x && size.z >= size.y {
        (DVec2::new(p.x, p.y), normal.z)
    } else if size.x >= size.y {
        (DVec2::new(p.y, p.z), normal.x)
    } else {
        (DVec2::new(p.z, p.x), normal.y)
    };
    if up >= 0.0 {
        flat
    } else {
        DVec2::new(flat.y, flat.x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DQuat;
    use proptest::prelude::*;

    /// A simple polygon: star-shaped about the origin, with any radii.
    fn star(radii: &[f64]) -> Vec<DVec2> {
        let step = std::f64::consts::TAU / radii.len() as f64;
        radii
            .iter()
            .enumerate()
            .map(|(i, &r)| DVec2::from_angle(step * i as f64) * r)
            .collect()
    }

    /// Twice the signed area in the plane.
    fn shoelace(ring: &[DVec2]) -> f64 {
        (0..ring.len())
            .map(|i| ring[i].perp_dot(ring[(i + 1) % ring.len()]))
            .sum()
    }

    fn check(flat: &[DVec2], turn: DQuat, shift: DVec3) -> Result<(), TestCaseError> {
        let ring: Vec<_> = flat.iter().map(|p| turn * p.extend(0.0) + shift).collect();
        let front = turn * DVec3::Z * shoelace(flat).signum();
        let result = Triangulator::new().triangulate(&ring);
        prop_assert!(!result.crosses_itself);
        let mut area = 0.0;
        for triangle in &result.triangles {
            let [a, b, c] = triangle.map(|i| ring[i as usize]);
            let normal = (b - a).cross(c - a);
            area += normal.length();
            prop_assert!(normal.dot(front) >= -1e-9, "a triangle is turned over");
        }
        prop_assert!((area - shoelace(flat).abs()).abs() < 1e-9 * (1.0 + area));
        Ok(())
    }

    proptest! {
        #[test]
        fn triangles_cover_the_polygon_and_keep_its_winding(
            radii in prop::collection::vec(0.05..1.0f64, 4..40),
            axis in prop::array::uniform3(-1.0..1.0f64),
            angle in 0.0..6.3f64,
            shift in prop::array::uniform3(-1.0..1.0f64),
            reversed in any::<bool>(),
        ) {
            let axis = DVec3::from(axis).try_normalize().unwrap_or(DVec3::X);
            let mut flat = star(&radii);
            if reversed {
                flat.reverse();
            }
            check(&flat, DQuat::from_axis_angle(axis, angle), shift.into())?;
        }
    }

    #[test]
    fn a_fan_would_be_wrong_here() {
        // An L and a comb, in which the first vertex does not see the others.
        let l = [(0., 0.), (2., 0.), (2., 1.), (1., 1.), (1., 2.), (0., 2.)];
        let comb = [
            (0., 0.),
            (5., 0.),
            (5., 3.),
            (4., 3.),
            (4., 1.),
            (3., 1.),
            (3., 3.),
            (2., 3.),
            (2., 1.),
            (1., 1.),
            (1., 3.),
            (0., 3.),
        ];
        for shape in [l.as_slice(), &comb] {
            for start in 0..shape.len() {
                let mut flat: Vec<_> = shape.iter().map(|&p| DVec2::from(p)).collect();
                flat.rotate_left(start);
                check(&flat, DQuat::from_rotation_y(0.3), DVec3::ONE).unwrap();
                flat.reverse();
                check(&flat, DQuat::IDENTITY, DVec3::ZERO).unwrap();
            }
        }
    }

    #[test]
    fn crossing_rings_are_noticed() {
        let bow = [(0., 0.), (2., 2.), (2., 0.), (0., 1.)];
        let ring: Vec<_> = bow.iter().map(|&(x, y)| DVec3::new(x, y, 0.0)).collect();
        assert!(Triangulator::new().triangulate(&ring).crosses_itself);
        let flat = [DVec3::ZERO, DVec3::X, DVec3::X * 2.0, DVec3::X * 0.5];
        assert!(Triangulator::new().triangulate(&flat).triangles.is_empty());
    }
}
