//! A triangle mesh under construction: vertices, triangles, materials and named objects.
//!
//! Lengths in metres, z up. Triangles run counter-clockwise seen from the lit side.

use super::material::Material;
use super::placement::Placement;
use glam::DVec3;

/// Index into [`Mesh::materials`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MaterialId(pub usize);

/// One triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Triangle {
    /// Indices into [`Mesh::vertices`].
    pub vertices: [usize; 3],
    /// What it is made of.
    pub material: MaterialId,
}

/// The triangles from `first` up to the next object's first belong to one object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Object {
    /// Name in the OBJ file, without its number.
    pub name: &'static str,
    /// Its first triangle.
    pub first: usize,
}

/// A mesh under construction.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Vertices; welded within a piece, never between pieces.
    pub vertices: Vec<DVec3>,
    /// Triangles in the order in which they are written.
    pub triangles: Vec<Triangle>,
    /// Materials in the order of first use.
    pub materials: Vec<Material>,
    /// Objects in ascending order of `first`; triangles before the first object have no name.
    pub objects: Vec<Object>,
}

impl Mesh {
    /// The id of `material`, which is added when new.
    pub fn material(&mut self, material: Material) -> MaterialId {
        let known = self.materials.iter().position(|m| m.name == material.name);
        let index = known.unwrap_or_else(|| {
            self.materials.push(material);
            self.materials.len() - 1
        });
        debug_assert_eq!(
            self.materials[index], material,
            "one name, one set of values"
        );
        MaterialId(index)
    }

    /// Adds a vertex.
    pub fn vertex(&mut self, position: DVec3) -> usize {
        self.vertices.push(position);
        self.vertices.len() - 1
    }

    /// Adds a triangle, counter-clockwise seen from its front.
    pub fn triangle(&mut self, vertices: [usize; 3], material: MaterialId) {
        self.triangles.push(Triangle { vertices, material });
    }

    /// Adds the quadrilateral `a b c d` as two triangles cut along `a c`.
    pub fn quad(&mut self, [a, b, c, d]: [usize; 4], material: MaterialId) {
        self.triangle([a, b, c], material);
        self.triangle([a, c, d], material);
    }

    /// Adds the triangles of `piece` as they stand, without naming them.
    pub fn append(&mut self, piece: &Self) {
        self.append_placed(piece, &Placement::IDENTITY);
    }

    /// Adds `piece` as a named object where `placement` puts it.
    pub fn place(&mut self, name: &'static str, piece: &Self, placement: Placement) {
        self.objects.push(Object {
            name,
            first: self.triangles.len(),
        });
        self.append_placed(piece, &placement);
    }

    /// Adds `piece` as a named object where it stands.
    pub fn object(&mut self, name: &'static str, piece: &Self) {
        self.place(name, piece, Placement::IDENTITY);
    }

    fn append_placed(&mut self, piece: &Self, placement: &Placement) {
        let base = self.vertices.len();
        self.vertices
            .extend(piece.vertices.iter().map(|&v| placement.apply(v)));
        let ids: Vec<MaterialId> = piece.materials.iter().map(|&m| self.material(m)).collect();
        self.triangles
            .extend(piece.triangles.iter().map(|t| Triangle {
                vertices: t.vertices.map(|v| v + base),
                material: ids[t.material.0],
            }));
    }

    /// The same surface facing the other way.
    #[must_use]
    pub fn turned_inside_out(mut self) -> Self {
        for triangle in &mut self.triangles {
            triangle.vertices.swap(1, 2);
        }
        self
    }
}
