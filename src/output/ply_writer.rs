//! Writes `solution.ply`: binary little-endian PLY (Turk 1994) with one face a leaf patch and side.

use super::{OutputError, SolvedMesh, ToneMap, write_atomically};
use std::io::{self, Write};
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// The properties of a face after its list of vertices, in file order.
pub(crate) const FACE_FLOATS: [&str; 6] = [
    "radiosity_r",
    "radiosity_g",
    "radiosity_b",
    "irradiance_r",
    "irradiance_g",
    "irradiance_b",
];

/// Writes the mesh to `path`, whole or not at all. Vertex colours are the tone-mapped mean of the
/// radiosity around each vertex, for viewers; the numbers stand on the faces.
///
/// # Errors
/// As [`write_atomically`], and [`OutputError::TooLarge`].
pub fn write_ply(
    path: &Path,
    mesh: &SolvedMesh,
    interrupted: &AtomicBool,
) -> Result<(), OutputError> {
    // Readers take indices and counts as signed 32-bit.
    let within = |count: usize, what| {
        if i32::try_from(count).is_ok() {
            return Ok(());
        }
        Err(OutputError::TooLarge {
            path: path.to_path_buf(),
            what,
            count,
        })
    };
    within(mesh.vertices.len(), "vertices")?;
    within(mesh.faces.len(), "faces")?;
    let greatest = mesh.faces.iter().map(|f| f.source_face).max().unwrap_or(0);
    within(greatest as usize, "source faces")?;
    let colours = vertex_colours(mesh);
    write_atomically(path, interrupted, |w| {
        encode(mesh, &colours, w).map_err(|e| OutputError::io("write", path, e))
    })
}

/// The file's bytes.
fn encode(mesh: &SolvedMesh, colours: &[[u8; 3]], w: &mut impl Write) -> io::Result<()> {
    w.write_all(header(mesh.vertices.len(), mesh.faces.len()).as_bytes())?;
    for (vertex, colour) in mesh.vertices.iter().zip(colours) {
        for x in vertex.to_array() {
            w.write_all(&x.to_le_bytes())?;
        }
        w.write_all(colour)?;
    }
    for face in &mesh.faces {
        w.write_all(&[3])?;
        for v in face.vertices {
            w.write_all(&v.to_le_bytes())?;
        }
        w.write_all(&face.source_face.to_le_bytes())?;
        w.write_all(&[face.side as u8])?;
        for x in face.radiosity.iter().chain(&face.irradiance) {
            w.write_all(&x.to_le_bytes())?;
        }
    }
    Ok(())
}

fn header(vertices: usize, faces: usize) -> String {
    let mut text = format!(
        "ply\nformat binary_little_endian 1.0\n\
         comment certilux solution: lengths in the input's units, radiosity and irradiance in W/m2\n\
         element vertex {vertices}\n\
         property double x\nproperty double y\nproperty double z\n\
         property uchar red\nproperty uchar green\nproperty uchar blue\n\
         element face {faces}\n\
         property list uchar int vertex_indices\n\
         property int source_face\nproperty uchar side\n"
    );
    for name in FACE_FLOATS {
        text.push_str("property float ");
        text.push_str(name);
        text.push('\n');
    }
    text.push_str("end_header\n");
    text
}

/// The tone-mapped, area-weighted mean radiosity of the faces around each vertex.
fn vertex_colours(mesh: &SolvedMesh) -> Vec<[u8; 3]> {
    let areas: Vec<f64> = mesh.faces.iter().map(|f| mesh.area(f)).collect();
    let tone_map = ToneMap::automatic(
        mesh.faces
            .iter()
            .zip(&areas)
            .map(|(face, &area)| (face.radiosity, area)),
    );
    let mut sums = vec![[0.0f64; 4]; mesh.vertices.len()];
    for (face, area) in mesh.faces.iter().zip(&areas) {
        for v in face.vertices {
            let sum = &mut sums[v as usize];
            for (s, b) in sum.iter_mut().zip(face.radiosity) {
                *s += area * f64::from(b);
            }
            sum[3] += area;
        }
    }
    sums.into_iter()
        .map(|[r, g, b, area]| {
            let mean = |sum: f64| if area > 0.0 { (sum / area) as f32 } else { 0.0 };
            tone_map.encode([mean(r), mean(g), mean(b)])
        })
        .collect()
}
