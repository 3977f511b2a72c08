//! What `REF.json` and `solution.ply` give to the comparison of a solution with a reference.

use super::reference_file::{ReferenceFace, mean};
use super::solved_mesh::SolvedMesh;
use crate::reference::{FaceRadiosity, ReferenceNoise, SolvedLights, TrueFace, reference_noise};
use crate::scene::{Scene, Side};
use std::collections::HashMap;
use std::f64::consts::PI;

/// Why a reference cannot be compared with.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ComparisonError {
    /// The records do not say what the faces are made of.
    #[error(
        "face {face} of the reference has no Kd_rgb or no Ke_rgb; name its scene with --scene SCENE.obj"
    )]
    MaterialUnknown {
        /// Index of the face.
        face: u32,
    },
    /// The scene is another one.
    #[error("face {face} of the reference is not in the scene of --scene, which has {faces} faces")]
    NotInScene {
        /// Index of the face.
        face: u32,
        /// Faces of the scene.
        faces: u32,
    },
}

/// The faces of a reference that reflect. Where a record does not say what it is made of, `scene` does.
///
/// # Errors
/// A record without material and no scene to tell; a face that the scene does not have.
pub fn true_faces(
    records: &[ReferenceFace],
    scene: Option<&Scene>,
) -> Result<Vec<TrueFace>, ComparisonError> {
    let mut surfaces = HashMap::new();
    for polygon in scene.iter().flat_map(|s| &s.polygons) {
        surfaces.insert(polygon.source_face, polygon.surface);
    }
    let mut faces = Vec::with_capacity(records.len());
    for record in records {
        let face = record.face_index;
        let side = if record.side == 0 {
            Side::Front
        } else {
            Side::Back
        };
        let (reflectance, emission) = match (record.reflectance, record.emission, scene) {
            (Some(reflectance), Some(emission), _) => (reflectance, emission),
            (_, _, None) => return Err(ComparisonError::MaterialUnknown { face }),
            (reflectance, emission, Some(scene)) => {
                let Some(&surface) = surfaces.get(&face) else {
                    return Err(ComparisonError::NotInScene {
                        face,
                        faces: scene.source_faces,
                    });
                };
                let surface = &scene.surfaces[surface as usize];
                let emitted = match side {
                    Side::Front => surface.emission,
                    Side::Back => [0.0; 3],
                };
                (
                    reflectance.unwrap_or(surface.reflectance),
                    emission.unwrap_or(emitted),
                )
            }
        };
        if reflectance == [0.0; 3] {
            continue;
        }
        let emitted = PI * mean(emission);
        faces.push(TrueFace {
            face,
            side,
            area: record.area,
            reflected: mean(record.radiosity) - emitted,
            // The channels share their paths, so their errors add up as they are.
            standard_error: mean(record.standard_error),
            emitted,
        });
    }
    Ok(faces)
}

/// The noise of a measurement, from its faces that reflect, as a comparison with its file has it; nothing where no face
/// reflects any light.
pub fn noise_of_faces(faces: &[FaceRadiosity]) -> Option<ReferenceNoise> {
    let records: Vec<ReferenceFace> = faces.iter().map(ReferenceFace::from).collect();
    // Their records say what they are made of.
    let truth = true_faces(&records, None).ok()?;
    reference_noise(&truth).ok()
}

/// The light of a solution by source face and side.
pub fn solved_lights(mesh: &SolvedMesh) -> SolvedLights {
    let mut lights = SolvedLights::new();
    for face in &mesh.faces {
        let area = mesh.area(face);
        let light = lights.entry((face.source_face, face.side)).or_default();
        light.area += area;
        light.power += area * mean(face.radiosity.map(f64::from));
    }
    lights
}
