//! From faces to the triangles that are kept: cut, freed of what has no area, freed of copies.

use super::degenerate::{Shape, repeated, shape_of, turn_to_least, weld_exact};
use super::model::Normalisation;
use super::obj_parse::RawMesh;
use super::triangulate::Triangulator;
use glam::{DVec3, Vec3};

/// A triangle that is kept: its corners as indices into `RawMesh::corners`, and its face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Piece {
    pub corners: [u32; 3],
    pub face: u32,
}

/// The outcome, faces and pieces in file order.
#[derive(Debug, Default)]
pub(super) struct Pieces {
    pub kept: Vec<Piece>,
    /// Faces of which nothing is left, ascending.
    pub dropped_faces: Vec<u32>,
    /// Faces without area, by their shape alone.
    pub without_area: Tally,
    /// Faces with an honest shape, but too small beside the scene for f32.
    pub collapsed: Tally,
    /// Faces that repeat an earlier one.
    pub duplicates: Tally,
    /// Faces whose outline crosses itself; what ear clipping makes of them is kept.
    pub crossing: Tally,
}

/// How many faces, and the first of them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Tally {
    pub count: usize,
    pub first: u32,
}

impl Tally {
    fn add(&mut self, face: u32) {
        if self.count == 0 {
            self.first = face;
        }
        self.count += 1;
    }
}

/// Cuts the faces of `mesh` into triangles and drops what cannot receive light of its own.
/// `rounded` are its positions, normalised by `map` and rounded to f32.
pub(super) fn cut_faces(mesh: &RawMesh, map: &Normalisation, rounded: &[Vec3]) -> Pieces {
    let welded = weld_exact(rounded);
    let vertex = |corner: u32| mesh.corners[corner as usize];
    let exact = |corner: u32| map.place(mesh.positions[vertex(corner) as usize]);
    let shape = |corners: [u32; 3]| {
        let rounded = corners.map(|c| rounded[vertex(c) as usize]);
        shape_of(corners.map(exact), rounded)
    };
    let mut out = Pieces::default();
    let copies = copied_polygons(mesh, &welded);
    let mut triangulator = Triangulator::new();
    let mut fates = vec![Fate::Kept; mesh.face_count()];
    let mut ring: Vec<u32> = Vec::new();
    let mut points: Vec<DVec3> = Vec::new();
    for (face, fate) in fates.iter_mut().enumerate() {
        let id = face as u32;
        if copies.binary_search(&id).is_ok() {
            *fate = Fate::Duplicate;
            continue;
        }
        open_ring(mesh, &welded, face, &mut ring);
        *fate = Fate::WithoutArea;
        if ring.len() < 3 {
            // Corners that coincide in f32 only are a matter of size, not of shape.
            let range = mesh.corner_range(face);
            let first = range.start as u32;
            let fan = (1..range.len().max(2) as u32 - 1).map(|i| [first, first + i, first + i + 1]);
            if fan.into_iter().any(|c| shape(c) == Shape::Collapsed) {
                *fate = Fate::Collapsed;
            }
        } else {
            points.clear();
            points.extend(ring.iter().map(|&c| exact(c)));
            let cut = triangulator.triangulate(&points);
            if cut.crosses_itself {
                out.crossing.add(id);
            }
            for triangle in cut.triangles {
                let corners = triangle.map(|i| ring[i as usize]);
                match shape(corners) {
                    Shape::Sound => {
                        *fate = Fate::Kept;
                        out.kept.push(Piece { corners, face: id });
                    }
                    Shape::Collapsed if *fate == Fate::WithoutArea => *fate = Fate::Collapsed,
                    Shape::Collapsed | Shape::Degenerate => {}
                }
            }
        }
    }
    drop_copies(&mut out, &welded, mesh, &mut fates);
    for (face, fate) in fates.into_iter().enumerate() {
        let id = face as u32;
        match fate {
            Fate::Kept => continue,
            Fate::Duplicate => out.duplicates.add(id),
            Fate::Collapsed => out.collapsed.add(id),
            Fate::WithoutArea => out.without_area.add(id),
        }
        out.dropped_faces.push(id);
    }
    out
}

/// What becomes of a face.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fate {
    Kept,
    Duplicate,
    Collapsed,
    WithoutArea,
}

/// The corners of a face without those that repeat their predecessor's place.
fn open_ring(mesh: &RawMesh, welded: &[u32], face: usize, ring: &mut Vec<u32>) {
    let place = |corner: &u32| welded[mesh.corners[*corner as usize] as usize];
    ring.clear();
    ring.extend(mesh.corner_range(face).map(|c| c as u32));
    ring.dedup_by_key(|c| place(c));
    while ring.len() > 1 && place(&ring[0]) == place(&ring[ring.len() - 1]) {
        ring.pop();
    }
}

/// Faces of more than three corners that go round the same places as an earlier one. Two equal
/// n-gons may be cut differently, so that comparing their triangles would miss them.
fn copied_polygons(mesh: &RawMesh, welded: &[u32]) -> Vec<u32> {
    let mut faces = Vec::new();
    let mut rings: Vec<Box<[u32]>> = Vec::new();
    let mut ring = Vec::new();
    for face in 0..mesh.face_count() {
        if mesh.corner_range(face).len() > 3 {
            open_ring(mesh, welded, face, &mut ring);
            if ring.len() < 3 {
                continue;
            }
            let mut places: Box<[u32]> = ring
                .iter()
                .map(|&c| welded[mesh.corners[c as usize] as usize])
                .collect();
            turn_to_least(&mut places);
            faces.push(face as u32);
            rings.push(places);
        }
    }
    repeated(&rings)
        .into_iter()
        .map(|i| faces[i as usize])
        .collect()
}

/// Drops triangles that repeat an earlier one; a face that loses its last becomes a duplicate.
fn drop_copies(out: &mut Pieces, welded: &[u32], mesh: &RawMesh, fates: &mut [Fate]) {
    let keys: Vec<[u32; 3]> = out
        .kept
        .iter()
        .map(|piece| {
            let mut places = piece
                .corners
                .map(|c| welded[mesh.corners[c as usize] as usize]);
            turn_to_least(&mut places);
            places
        })
        .collect();
    let copies = repeated(&keys);
    if copies.is_empty() {
        return;
    }
    let mut index = 0;
    let kept_before = std::mem::take(&mut out.kept);
    for &i in &copies {
        fates[kept_before[i as usize].face as usize] = Fate::Duplicate;
    }
    out.kept = kept_before
        .into_iter()
        .filter(|_| {
            index += 1;
            copies.binary_search(&(index - 1)).is_err()
        })
        .collect();
    for piece in &out.kept {
        fates[piece.face as usize] = Fate::Kept;
    }
}
