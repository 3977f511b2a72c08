//! The checked text of an OBJ file, parsed by `tobj` into flat arrays.

use super::error::Reason;
use glam::{DVec2, DVec3};

/// The geometry of a file, in its units, faces in file order.
#[derive(Debug, Default)]
pub(super) struct RawMesh {
    /// Vertices that some face uses, in order of first use.
    pub positions: Vec<DVec3>,
    /// Texture coordinates that some face uses.
    pub texture_coordinates: Vec<DVec2>,
    /// First corner of each face, and one past the last corner of the last face.
    pub face_starts: Vec<u32>,
    /// Vertex of each corner.
    pub corners: Vec<u32>,
    /// Texture coordinate of each corner, empty if the file has none. Where
    /// `ObjScan::face_textured` is false the entry means nothing.
    pub corner_textures: Vec<u32>,
}

impl RawMesh {
    /// Number of faces.
    pub fn face_count(&self) -> usize {
        self.face_starts.len() - 1
    }

    /// The corners of a face as a range of `corners`.
    pub fn corner_range(&self, face: usize) -> std::ops::Range<usize> {
        self.face_starts[face] as usize..self.face_starts[face + 1] as usize
    }
}

/// Parses what [`super::obj_scan::scan_obj`] wrote.
///
/// # Errors
/// Only if `tobj` refuses the text or yields more corners than 32 bits can count.
pub(super) fn parse_obj(clean: String) -> Result<RawMesh, Reason> {
    let no_materials = |_: &std::path::Path| Ok(Default::default());
    let options = tobj::LoadOptions::default();
    let (models, _) = tobj::load_obj_buf(&mut clean.as_bytes(), &options, no_materials)
        .map_err(|e| Reason::Parser(e.to_string()))?;
    drop(clean);
    let Some(model) = models.into_iter().next() else {
        return Err(Reason::Parser("no mesh came out".into()));
    };
    let mesh = model.mesh;
    if u32::try_from(mesh.indices.len()).is_err() {
        return Err(Reason::TooMany {
            kind: "corners of faces",
            count: mesh.indices.len(),
        });
    }
    // A file of triangles comes without arities.
    let mut face_starts = vec![0];
    if mesh.face_arities.is_empty() {
        face_starts.extend((3..=mesh.indices.len() as u32).step_by(3));
    } else {
        let mut end = 0;
        face_starts.extend(mesh.face_arities.iter().map(|arity| {
            end += arity;
            end
        }));
    }
    Ok(RawMesh {
        positions: mesh
            .positions
            .chunks_exact(3)
            .map(DVec3::from_slice)
            .collect(),
        texture_coordinates: mesh
            .texcoords
            .chunks_exact(2)
            .map(DVec2::from_slice)
            .collect(),
        face_starts,
        corners: mesh.indices,
        corner_textures: mesh.texcoord_indices,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_keep_their_order_and_their_corners() {
        let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 9 9 9\nvt 0.5 0.25\nf 3 2 1\nf 1/1 2/1 3/1 4/1\n";
        let mesh = parse_obj(text.into()).unwrap();
        assert_eq!(mesh.face_count(), 2);
        let at = |face| -> Vec<DVec3> {
            mesh.corner_range(face)
                .map(|c| mesh.positions[mesh.corners[c] as usize])
                .collect()
        };
        assert_eq!(at(0), [DVec3::new(1.0, 1.0, 0.0), DVec3::X, DVec3::ZERO]);
        assert_eq!(at(1)[3], DVec3::Y);
        assert_eq!(mesh.positions.len(), 4, "unused vertices are left out");
        let texture = mesh.corner_textures[mesh.corner_range(1).start] as usize;
        assert_eq!(mesh.texture_coordinates[texture], DVec2::new(0.5, 0.25));
    }

    #[test]
    fn numbers_are_read_in_double_precision() {
        let text = "v 1000000.0000001 0 0\nv 1 0 0 3\nv 0 1 0\nf 1 2 3\n";
        let mesh = parse_obj(text.into()).unwrap();
        assert_eq!(mesh.positions[0].x, 1_000_000.000_000_1);
        assert_eq!(mesh.positions[1].x, 1.0 / 3.0);
    }
}
