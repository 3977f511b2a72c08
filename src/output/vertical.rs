//! Which axis of a solution is likely to be up.

use super::up_axis::UpAxis;
use super::view::View;
use glam::DVec3;

impl View<'_> {
    /// The vertical: +y, the custom of OBJ files, or +z. Lamps shine downwards, and buildings are
    /// lower than they are wide; y wins where neither tells.
    pub(super) fn vertical(&self) -> UpAxis {
        /// Lamps tell more than proportions do: a tower is taller than wide.
        const LAMPS: f64 = 2.0;
        /// Decides between equals.
        const CUSTOM: f64 = 0.1;
        let mut lamps = DVec3::ZERO;
        let mut power = 0.0;
        for (p, panel) in self.panels.panels.iter().enumerate() {
            let normal = self.panels.normal(panel);
            for face in &self.mesh.faces[self.panels.leaf_range(panel)] {
                let emitted: f64 = (0..3)
                    .map(|c| {
                        let reflected = self.reflectance[p][c] * face.irradiance[c];
                        f64::from(face.radiosity[c] - reflected)
                    })
                    .sum();
                let all: f64 = face.radiosity.iter().map(|&b| f64::from(b)).sum();
                // Less is the rounding of the reflectance, not a lamp.
                if emitted > 0.01 * all {
                    let weight = emitted * self.mesh.area(face);
                    lamps += weight * normal;
                    power += weight;
                }
            }
        }
        let lamps = if power > 0.0 { lamps / power } else { lamps };
        let extent = self.extent();
        let score = |axis: DVec3| {
            LAMPS * (-lamps.dot(axis)).max(0.0) + 1.0 - extent.dot(axis) / extent.max_element()
        };
        if score(DVec3::Z) > score(DVec3::Y) + CUSTOM {
            UpAxis::Z
        } else {
            UpAxis::Y
        }
    }

    /// Size of the bounding box in the units of the rays.
    fn extent(&self) -> DVec3 {
        let (least, greatest) = self.bounds();
        (greatest - least).max(DVec3::splat(f64::MIN_POSITIVE))
    }
}
