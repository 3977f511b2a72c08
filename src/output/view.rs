//! A solved mesh made ready for pictures: where a ray lands, and what light is there.

use super::camera::PinHole;
use super::panel::Panels;
use super::panel_reflectance::reflectance;
use super::smoothing::Smoothing;
use super::{Pixel, SolvedMesh};
use crate::embree::{CommittedScene, Device, EmbreeError, Hit, Ray};
use crate::scene::Side;
use glam::{DVec2, DVec3, Vec3};
use std::collections::HashMap;

/// How patches are shaded.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shading {
    /// Values at vertices, interpolated; creases are kept.
    #[default]
    Smooth,
    /// One value a patch.
    Flat,
}

/// How a picture is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct ViewConfig {
    /// Smooth or flat.
    pub shading: Shading,
    /// Rays along each side of a pixel; their square is the number of rays a pixel, 1 to 16 a side.
    pub samples_a_side: u32,
    /// Final gathering with so many rays a pixel, which also look past the pixel's edges in place of
    /// `samples_a_side`; 0 shows the solution itself.
    pub gather: u32,
}

impl Default for ViewConfig {
    /// 3 x 3 rays a pixel: edges without visible steps in well under a second a megapixel a core.
    fn default() -> Self {
        Self {
            shading: Shading::Smooth,
            samples_a_side: 3,
            gather: 0,
        }
    }
}

/// A solved mesh made ready for pictures: polygons in Embree, patches in trees, values at vertices.
pub struct View<'a> {
    pub(super) mesh: &'a SolvedMesh,
    pub(super) panels: Panels,
    smoothing: Smoothing,
    /// By panel: how irradiance becomes radiosity.
    pub(super) reflectance: Vec<[f32; 3]>,
    polygons: Vec<ViewPolygon>,
    pub(super) embree: CommittedScene,
    pub(super) frame: Frame,
}

/// A triangle with one panel, or one on each side.
struct ViewPolygon {
    /// Welded vertices, counter-clockwise seen from the front.
    corners: [u32; 3],
    front: Option<u32>,
    back: Option<u32>,
}

/// The map from the file's units to those in which rays are cast: about the unit cube, so that f32
/// serves scenes of any size and place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Frame {
    centre: DVec3,
    scale: f64,
}

impl Frame {
    fn around(positions: &[DVec3]) -> Self {
        let (least, greatest) = positions.iter().fold(
            (DVec3::INFINITY, DVec3::NEG_INFINITY),
            |(least, greatest), &p| (least.min(p), greatest.max(p)),
        );
        let extent = (greatest - least).max_element();
        if !(extent > 0.0 && extent.is_finite()) {
            return Self {
                centre: DVec3::ZERO,
                scale: 1.0,
            };
        }
        Self {
            // Halved first: the sum of two great coordinates need not be finite.
            centre: 0.5 * least + 0.5 * greatest,
            scale: 1.0 / extent,
        }
    }

    /// A point of the file, in the units of the rays.
    pub fn point(&self, file: DVec3) -> Vec3 {
        ((file - self.centre) * self.scale).as_vec3()
    }

    /// A point in the units of the rays, in the file's.
    pub fn to_file(self, point: DVec3) -> DVec3 {
        point / self.scale + self.centre
    }
}

/// The light of a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Seen {
    pub radiosity: [f32; 3],
    pub irradiance: [f32; 3],
}

/// A place on a side that has light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Landing {
    pub panel: usize,
    /// The patch under it, an index of the mesh's faces.
    pub leaf: usize,
    /// Barycentric weights in the panel.
    pub weights: [f64; 3],
    /// Barycentric weights in the patch.
    pub local: [f64; 3],
}

impl<'a> View<'a> {
    /// Builds what pictures of `mesh` need.
    ///
    /// # Errors
    /// [`EmbreeError`] when Embree refuses, for want of memory for example.
    pub fn new(mesh: &'a SolvedMesh, device: &Device) -> Result<Self, EmbreeError> {
        let panels = Panels::new(mesh);
        let smoothing = Smoothing::new(mesh, &panels);
        let frame = Frame::around(&panels.positions);
        let polygons = pair_sides(mesh, &panels);
        let positions: Vec<Vec3> = panels.positions.iter().map(|&p| frame.point(p)).collect();
        let triangles: Vec<[u32; 3]> = polygons.iter().map(|p| p.corners).collect();
        let embree = CommittedScene::build(device, &positions, &triangles)?;
        let reflectance = (panels.panels.iter())
            .map(|panel| reflectance(mesh, &panels, panel))
            .collect();
        Ok(Self {
            mesh,
            panels,
            smoothing,
            reflectance,
            polygons,
            embree,
            frame,
        })
    }

    /// The mesh.
    pub fn mesh(&self) -> &SolvedMesh {
        self.mesh
    }

    /// Least and greatest corner of the scene in the units of the rays.
    pub(super) fn bounds(&self) -> (DVec3, DVec3) {
        self.panels.positions.iter().fold(
            (DVec3::INFINITY, DVec3::NEG_INFINITY),
            |(least, greatest), &p| {
                let p = self.frame.point(p).as_dvec3();
                (least.min(p), greatest.max(p))
            },
        )
    }

    /// The ray through a point of the picture; its `t` is the depth in the units of the rays.
    pub(super) fn ray(&self, camera: &PinHole, x: f64, y: f64) -> Ray {
        Ray::half_line(
            self.frame.point(camera.eye()),
            camera.direction(DVec2::new(x, y)).as_vec3(),
            0.0,
        )
    }

    /// Which side of its polygon a hit sees: decided by the eye's place and not by the ray's
    /// rounded direction.
    fn side_seen(&self, hit: &Hit, eye: DVec3) -> Side {
        let polygon = &self.polygons[hit.polygon.index()];
        let [a, b, c] = polygon.corners.map(|v| self.panels.positions[v as usize]);
        if (b - a).cross(c - a).dot(eye - a) >= 0.0 {
            Side::Front
        } else {
            Side::Back
        }
    }

    /// The panel that a ray from `eye` meets; `None` for a side without light.
    pub(super) fn panel_seen(&self, hit: &Hit, eye: DVec3) -> Option<usize> {
        let polygon = &self.polygons[hit.polygon.index()];
        match self.side_seen(hit, eye) {
            Side::Front => polygon.front,
            Side::Back => polygon.back,
        }
        .map(|p| p as usize)
    }

    /// Fills in the layers that hold for the pixel's middle.
    pub(super) fn identify(&self, hit: &Hit, camera: &PinHole, pixel: &mut Pixel) {
        let polygon = &self.polygons[hit.polygon.index()];
        let [a, b, c] = polygon.corners.map(|v| self.panels.positions[v as usize]);
        let normal = (b - a).cross(c - a).normalize_or_zero();
        let (sign, panel) = match self.side_seen(hit, camera.eye()) {
            Side::Front => (1.0, polygon.front.or(polygon.back)),
            Side::Back => (-1.0, polygon.back.or(polygon.front)),
        };
        pixel.normal = (normal * sign).as_vec3().to_array();
        pixel.depth = (f64::from(hit.t) / self.frame.scale) as f32;
        if let Some(panel) = panel {
            pixel.face = self.panels.panels[panel as usize].source_face as f32;
        }
    }

    /// Where a ray from `eye` (in the file's units) has landed; `None` on a side without light.
    pub(super) fn landing(&self, hit: &Hit, eye: DVec3) -> Option<Landing> {
        let polygon = &self.polygons[hit.polygon.index()];
        let p = self.panel_seen(hit, eye)?;
        let panel = &self.panels.panels[p];
        // Rounding may leave a hit a little outside of its triangle.
        let v = f64::from(hit.u).clamp(0.0, 1.0);
        let w = f64::from(hit.v).clamp(0.0, 1.0 - v);
        let of_polygon = [1.0 - v - w, v, w];
        let weights = panel.corners.map(|corner| {
            let place = (polygon.corners.iter()).position(|&other| other == corner);
            of_polygon[place.expect("both sides of a polygon have the same corners")]
        });
        let (leaf, local) = self.panels.leaf_at(panel, weights);
        Some(Landing {
            panel: p,
            leaf,
            weights,
            local: local.map(|x| x.clamp(0.0, 1.0)),
        })
    }

    /// The light of a place, which leaves it alike in all directions.
    pub(super) fn light_at(&self, place: &Landing, shading: Shading) -> Seen {
        let face = &self.mesh.faces[place.leaf];
        if shading == Shading::Flat {
            return Seen {
                radiosity: face.radiosity,
                irradiance: face.irradiance,
            };
        }
        let irradiance = (self.smoothing.irradiance(place.leaf, place.local)).map(|x| x as f32);
        let reflectance = self.reflectance[place.panel];
        Seen {
            radiosity: std::array::from_fn(|c| {
                let more = irradiance[c] - face.irradiance[c];
                (face.radiosity[c] + reflectance[c] * more).max(0.0)
            }),
            irradiance,
        }
    }
}

/// Joins the two sides of each triangle; corners run as seen from the front. Sheets laid back to
/// back on the same three vertices become one, or rays would meet either at random.
fn pair_sides(mesh: &SolvedMesh, panels: &Panels) -> Vec<ViewPolygon> {
    let mut index: HashMap<[u32; 3], usize> = HashMap::with_capacity(panels.panels.len());
    let mut polygons: Vec<ViewPolygon> = Vec::with_capacity(panels.panels.len());
    let lit = |p: u32| {
        let range = panels.leaf_range(&panels.panels[p as usize]);
        (mesh.faces[range].iter()).any(|face| face.radiosity.iter().any(|&b| b > 0.0))
    };
    for (p, panel) in (0u32..).zip(&panels.panels) {
        let mut sorted = panel.corners;
        sorted.sort_unstable();
        let [a, b, c] = panel.corners;
        let i = *index.entry(sorted).or_insert_with(|| {
            polygons.push(ViewPolygon {
                corners: match panel.side {
                    Side::Front => [a, b, c],
                    Side::Back => [a, c, b],
                },
                front: None,
                back: None,
            });
            polygons.len() - 1
        });
        let polygon = &mut polygons[i];
        let [a, b, c] = polygon.corners;
        let turned_alike = [[a, b, c], [b, c, a], [c, a, b]].contains(&panel.corners);
        let place = if turned_alike {
            &mut polygon.front
        } else {
            &mut polygon.back
        };
        if place.is_none_or(|other| !lit(other) && lit(p)) {
            *place = Some(p);
        }
    }
    polygons
}
