//! The error of a solution as numbers of its patches.

use super::SolvedMesh;
use crate::reference::SolutionError;
use std::collections::HashMap;

/// For each face of `mesh`, how much brighter its source face and side is than the reference, in percent of the
/// reference's mean reflected radiosity; `None` where the reference says nothing.
pub fn errors_of_faces(mesh: &SolvedMesh, error: &SolutionError) -> Vec<Option<f64>> {
    let known: HashMap<_, _> = (error.faces.iter())
        .map(|f| {
            (
                (f.face, f.side),
                100.0 * (f.solution - f.reference) / error.mean,
            )
        })
        .collect();
    (mesh.faces.iter())
        .map(|face| known.get(&(face.source_face, face.side)).copied())
        .collect()
}
