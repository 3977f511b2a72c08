//! Facet data that a solve looks up all the time.

use super::facet_frame::FacetFrame;
use super::radiosity::Light;
use crate::cluster::Hierarchy;
use crate::math::FacetId;
use crate::scene::Scene;
use glam::Vec3;
use std::f64::consts::PI;

/// Facet data, in the hierarchy's facet order.
#[derive(Clone, Debug)]
pub struct FacetTable<const C: usize> {
    /// Unit normals.
    pub normals: Vec<Vec3>,
    /// Where points on them lie.
    pub frames: Vec<FacetFrame>,
    /// How many facets before each are touched by solids; one longer.
    pub touched_before: Vec<u32>,
    /// Areas, normalised.
    pub areas: Vec<f64>,
    /// Sums of the areas before each facet; one longer.
    pub area_before: Vec<f64>,
    /// Reflectances.
    pub reflectance: Vec<Light<C>>,
    /// Emitted radiosity pi Ke over [`Self::unit`].
    pub emitted: Vec<Light<C>>,
    /// Radiosity in W/m2 that the solve counts as 1: a power of two near the greatest emission, so
    /// that any Ke is solved with the same bits.
    pub unit: f64,
    /// Area of the scene, one side of each polygon.
    pub polygon_area: f64,
}

impl<const C: usize> FacetTable<C> {
    /// Looks everything up once.
    pub fn new(scene: &Scene, hierarchy: &Hierarchy) -> Self {
        let greatest = scene
            .surfaces
            .iter()
            .flat_map(|s| s.emission)
            .fold(0.0f64, f64::max);
        let unit = if greatest > 0.0 {
            greatest.log2().floor().exp2()
        } else {
            1.0
        };
        let mut table = Self {
            normals: Vec::with_capacity(hierarchy.facets.len()),
            frames: Vec::new(),
            touched_before: vec![0],
            areas: Vec::with_capacity(hierarchy.facets.len()),
            area_before: vec![0.0],
            reflectance: Vec::with_capacity(hierarchy.facets.len()),
            emitted: Vec::with_capacity(hierarchy.facets.len()),
            unit,
            polygon_area: (0..scene.polygons.len())
                .map(|p| scene.polygon_area(crate::math::PolygonId::new(p)))
                .sum(),
        };
        let mut sum = 0.0;
        for &facet in &hierarchy.facets {
            let [a, b, c] = scene.facet_corners(facet).map(Vec3::as_dvec3);
            let cross = (b - a).cross(c - a);
            let area = 0.5 * cross.length();
            sum += area;
            table.normals.push(cross.normalize_or_zero().as_vec3());
            table.areas.push(area);
            table.area_before.push(sum);
            let reflectance = scene.surface(facet.polygon).reflectance;
            let emission = scene.emission(facet);
            table
                .reflectance
                .push(std::array::from_fn(|k| reflectance[k]));
            table
                .emitted
                .push(std::array::from_fn(|k| PI * (emission[k] / unit)));
        }
        table.frames = FacetFrame::of_all(scene, hierarchy, &table.normals);
        let mut touched = 0;
        table
            .touched_before
            .extend(table.frames.iter().map(|frame| {
                touched += u32::from(frame.is_touched);
                touched
            }));
        table
    }

    /// Area of a facet.
    pub fn area(&self, facet: FacetId) -> f64 {
        self.areas[facet.index()]
    }
}
