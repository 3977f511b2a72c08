//! The validated scene: what every later stage works on.
//!
//! Lengths here are *normalised*: the scene is turned to its own axes, centred and scaled by a power of two so that its
//! bounding box fits the unit cube around the origin (`[-1/2, 1/2]^3`). [`Normalisation`] maps
//! back to the file's units, and `source_positions` keeps the vertices as they were read.

use super::contacts::Contacts;
use super::facet::{Facet, Side};
use super::orientation::degrees_askew;
use crate::math::{Aabb, PolygonId};
use glam::{DMat3, DVec3, Vec3};

/// A triangle. Its front is the side from which the vertices run counter-clockwise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Polygon {
    /// Indices into `Scene::positions`.
    pub vertices: [u32; 3],
    /// 0-based index, in file order, of the `f` statement that it came from.
    pub source_face: u32,
    /// Index into `Scene::surfaces`.
    pub surface: u32,
}

/// What a polygon is made of: one per material, or per material and texture colour.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// Name of the material in the MTL file, for messages.
    pub material: String,
    /// Diffuse reflectance `Kd` of red, green and blue, each in [0, 1).
    pub reflectance: [f64; 3],
    /// Emitted radiance `Ke` in W/m2/sr (emitted radiosity is pi times it), from the winding side only.
    pub emission: [f64; 3],
}

/// The map between the file's units and normalised units: `normalised = turn * (read - centre) * scale`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Normalisation {
    /// Centre of the scene's bounding box along its own axes, in the file's units and axes.
    pub centre: DVec3,
    /// A power of two, in normalised lengths per unit of the file.
    pub scale: f64,
    /// Rotation from the file's axes to those of the scene (`orientation.rs`).
    pub turn: DMat3,
}

impl Normalisation {
    /// A normalised point in the file's units.
    pub fn to_file(&self, point: DVec3) -> DVec3 {
        self.turn.transpose() * (point / self.scale) + self.centre
    }

    /// A direction in the file's axes.
    pub fn direction_to_file(&self, direction: Vec3) -> Vec3 {
        (self.turn.transpose() * direction.as_dvec3()).as_vec3()
    }

    /// A point in the file's units, normalised.
    pub fn place(&self, point: DVec3) -> DVec3 {
        self.turn * (point - self.centre) * self.scale
    }

    /// A point in the file's units, normalised and rounded to f32.
    pub fn to_normalised(&self, point: DVec3) -> Vec3 {
        self.place(point).as_vec3()
    }

    /// Angle in degrees between the scene's axes and those of the file, whichever is which.
    pub fn degrees_askew(&self) -> f64 {
        degrees_askew(self.turn)
    }

    /// A normalised area in the square of the file's units.
    pub fn area_to_file(&self, area: f64) -> f64 {
        area / (self.scale * self.scale)
    }
}

/// Something the user should know about the input, though the work goes on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SceneWarning(pub String);

/// A validated scene. Every polygon has three distinct, finite vertices and a positive area; every
/// reflectance is in [0, 1); every index is in range; at least one polygon emits.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Where it came from: a path, or `builtin:NAME`.
    pub name: String,
    /// Normalised vertices.
    pub positions: Vec<Vec3>,
    /// The same vertices, in the same order, as they were read, in the file's units.
    pub source_positions: Vec<DVec3>,
    /// Triangles, in file order.
    pub polygons: Vec<Polygon>,
    /// Surface properties.
    pub surfaces: Vec<Surface>,
    /// The map back to the file's units.
    pub normalisation: Normalisation,
    /// Number of `f` statements in the file, dropped ones included.
    pub source_faces: u32,
    /// Faces dropped at loading (zero area, duplicates), ascending.
    pub dropped_faces: Vec<u32>,
    /// Which parts of sides solids hide by standing on them.
    pub contacts: Contacts,
    /// What was odd about the input.
    pub warnings: Vec<SceneWarning>,
}

impl Scene {
    /// The normalised corners of a polygon.
    pub fn corners(&self, id: PolygonId) -> [Vec3; 3] {
        self.polygons[id.index()]
            .vertices
            .map(|v| self.positions[v as usize])
    }

    /// The corners of a facet, counter-clockwise seen from its side.
    pub fn facet_corners(&self, facet: Facet) -> [Vec3; 3] {
        let [a, b, c] = self.corners(facet.polygon);
        match facet.side {
            Side::Front => [a, b, c],
            Side::Back => [a, c, b],
        }
    }

    /// The corners of a polygon in the file's units, as read.
    pub fn source_corners(&self, id: PolygonId) -> [DVec3; 3] {
        self.polygons[id.index()]
            .vertices
            .map(|v| self.source_positions[v as usize])
    }

    /// The surface of a polygon.
    pub fn surface(&self, id: PolygonId) -> &Surface {
        &self.surfaces[self.polygons[id.index()].surface as usize]
    }

    /// The emitted radiance of a facet: its surface's on the front, black on the back.
    pub fn emission(&self, facet: Facet) -> [f64; 3] {
        match facet.side {
            Side::Front => self.surface(facet.polygon).emission,
            Side::Back => [0.0; 3],
        }
    }

    /// The normalised bounding box.
    pub fn bounds(&self) -> Aabb {
        Aabb::from_points(self.positions.iter().copied())
    }

    /// Depth below a surface within which nothing blocks and nothing is claimed: 1e-6 of the diagonal.
    pub fn tau(&self) -> f32 {
        1.0e-6 * self.bounds().diagonal()
    }

    /// Area of a polygon, normalised.
    pub fn polygon_area(&self, id: PolygonId) -> f64 {
        let [a, b, c] = self.corners(id).map(Vec3::as_dvec3);
        0.5 * (b - a).cross(c - a).length()
    }

    /// Number of channels that the scene needs: 1 where every reflectance and emission is grey, else 3.
    pub fn channels(&self) -> usize {
        let grey = |c: [f64; 3]| c[0] == c[1] && c[1] == c[2];
        if self
            .surfaces
            .iter()
            .all(|s| grey(s.reflectance) && grey(s.emission))
        {
            1
        } else {
            3
        }
    }
}
