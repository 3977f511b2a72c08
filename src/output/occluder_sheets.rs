//! Occluders as sheets that rays through a picture pass.

use super::cluster_colours::cluster_colour;
use super::overlay::{Mark, Sight};
use super::view::Frame;
use crate::embree::{AllHitsScene, Device, EmbreeError, Ray};
use crate::math::hash_u64;
use crate::occluder::OccluderSet;
use crate::scene::Scene;
use glam::Vec3;

/// Opacity of one sheet.
const OPACITY: f32 = 0.55;

/// How far behind the surface that covers it a sheet is still seen, beside its thickness, in the
/// units of the rays: rounding of both meshes.
const SLACK: f32 = 1.0e-5;

/// Least cosine by which that depth is divided: a sheet seen edge-on is not seen through a wall.
const LEAST_COSINE: f32 = 0.05;

/// The rectangles of a set in the units of a view's rays, two triangles each.
pub(super) struct OccluderSheets {
    sheets: AllHitsScene,
    normals: Vec<Vec3>,
    /// How far from the middle of the rectangle its surface may lie.
    depths: Vec<f32>,
}

impl OccluderSheets {
    pub fn new(
        scene: &Scene,
        set: &OccluderSet,
        frame: &Frame,
        device: &Device,
    ) -> Result<Self, EmbreeError> {
        let file = |p: Vec3| frame.point(scene.normalisation.to_file(p.as_dvec3()));
        let mut positions = Vec::with_capacity(4 * set.occluders.len());
        let mut triangles = Vec::with_capacity(2 * set.occluders.len());
        let (mut normals, mut depths) = (Vec::new(), Vec::new());
        for occluder in &set.occluders {
            let slab = &occluder.slab;
            let first = positions.len() as u32;
            positions.extend(slab.corners.map(file));
            triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
            normals.push(scene.normalisation.direction_to_file(slab.normal));
            let through = file(slab.corners[0] + slab.normal * slab.half_thickness);
            depths.push(2.0 * (through - file(slab.corners[0])).length() + SLACK);
        }
        Ok(Self {
            sheets: AllHitsScene::build(device, &positions, &triangles)?,
            normals,
            depths,
        })
    }

    /// The sheets in front of what is seen, or upon it, laid over each other.
    pub fn mark(&self, sight: &Sight) -> Mark {
        let deepest = self.depths.iter().copied().fold(0.0, f32::max);
        let length = sight.ray.direction.length();
        let reach = Ray {
            tfar: sight.hit.t + deepest / (LEAST_COSINE * length),
            ..sight.ray
        };
        let mut seen = Vec::new();
        self.sheets.for_each_hit(&reach, |hit| {
            let sheet = hit.polygon.index() / 2;
            let cosine = self.normals[sheet].dot(sight.ray.direction).abs() / length;
            let behind = (hit.t - sight.hit.t) * length * cosine.max(LEAST_COSINE);
            if behind <= self.depths[sheet] {
                seen.push(sheet);
            }
        });
        // Of sheets in one plane rounding says which is the first, ray by ray: laid in the order of the set instead.
        // A ray through a sheet's diagonal meets both of its triangles.
        seen.sort_unstable();
        seen.dedup();
        let mut mark = Mark {
            colour: [0.0; 3],
            opacity: 0.0,
            id: u32::MAX - 1,
        };
        for sheet in seen {
            mark.id = hash_u64(u64::from(mark.id) << 32 | sheet as u64) as u32;
            let colour = cluster_colour(sheet).map(|x| (f32::from(x) / 255.0).powi(2));
            let share = (1.0 - mark.opacity) * OPACITY;
            let opacity = mark.opacity + share;
            for (sum, c) in mark.colour.iter_mut().zip(colour) {
                *sum = (*sum * mark.opacity + c * share) / opacity;
            }
            mark.opacity = opacity;
        }
        mark
    }
}
