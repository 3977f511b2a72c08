//! Writes `solution.vtu`: an unstructured grid of VTK's XML formats (VTK User's Guide, "File Formats"), for ParaView.
//!
//! One triangle a leaf patch and side, in the order of `solution.ply`, with `radiosity` and `irradiance` (three
//! components, W/m2), `source_face` and `side` as data of the cells.

use super::{OutputError, SolvedFace, SolvedMesh, write_atomically};
use base64::engine::general_purpose::STANDARD;
use base64::write::EncoderWriter;
use std::io::{self, Write};
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// VTK's number of a triangle.
const TRIANGLE: u8 = 5;

/// Writes the mesh to `path`, whole or not at all.
///
/// # Errors
/// As [`write_atomically`], and [`OutputError::TooLarge`].
pub fn write_vtu(
    path: &Path,
    mesh: &SolvedMesh,
    interrupted: &AtomicBool,
) -> Result<(), OutputError> {
    let greatest = mesh.faces.iter().map(|f| f.source_face).max().unwrap_or(0);
    if i32::try_from(greatest).is_err() {
        return Err(OutputError::TooLarge {
            path: path.to_path_buf(),
            what: "source faces",
            count: greatest as usize,
        });
    }
    write_atomically(path, interrupted, |w| {
        encode(mesh, w).map_err(|e| OutputError::io("write", path, e))
    })
}

fn encode(mesh: &SolvedMesh, w: &mut impl Write) -> io::Result<()> {
    let (points, cells) = (mesh.vertices.len(), mesh.faces.len());
    write!(
        w,
        "<?xml version=\"1.0\"?>\n\
         <VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n\
         <UnstructuredGrid>\n<Piece NumberOfPoints=\"{points}\" NumberOfCells=\"{cells}\">\n<Points>\n"
    )?;
    let places = mesh
        .vertices
        .iter()
        .map(|v| v.to_array().map(f64::to_le_bytes));
    array(w, "Points", "Float64", 3, 24 * points, places)?;
    write!(w, "</Points>\n<Cells>\n")?;
    let corners = (mesh.faces.iter()).map(|f| f.vertices.map(|v| i64::from(v).to_le_bytes()));
    array(w, "connectivity", "Int64", 1, 24 * cells, corners)?;
    let ends = (1..=cells as i64).map(|end| [(3 * end).to_le_bytes()]);
    array(w, "offsets", "Int64", 1, 8 * cells, ends)?;
    let types = std::iter::repeat_n([[TRIANGLE]], cells);
    array(w, "types", "UInt8", 1, cells, types)?;
    write!(w, "</Cells>\n<CellData Vectors=\"radiosity\">\n")?;
    let light = |of: fn(&SolvedFace) -> [f32; 3]| {
        mesh.faces.iter().map(move |f| of(f).map(f32::to_le_bytes))
    };
    array(
        w,
        "radiosity",
        "Float32",
        3,
        12 * cells,
        light(|f| f.radiosity),
    )?;
    array(
        w,
        "irradiance",
        "Float32",
        3,
        12 * cells,
        light(|f| f.irradiance),
    )?;
    let faces = mesh.faces.iter().map(|f| [f.source_face.to_le_bytes()]);
    array(w, "source_face", "Int32", 1, 4 * cells, faces)?;
    let sides = mesh.faces.iter().map(|f| [[f.side as u8]]);
    array(w, "side", "UInt8", 1, cells, sides)?;
    write!(
        w,
        "</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n"
    )
}

/// One array of `bytes` bytes: their number and then they, in base 64.
fn array<const N: usize, const K: usize>(
    w: &mut impl Write,
    name: &str,
    kind: &str,
    components: usize,
    bytes: usize,
    items: impl Iterator<Item = [[u8; N]; K]>,
) -> io::Result<()> {
    writeln!(
        w,
        "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"binary\">"
    )?;
    let mut encoder = EncoderWriter::new(&mut *w, &STANDARD);
    encoder.write_all(&(bytes as u64).to_le_bytes())?;
    for item in items {
        encoder.write_all(item.as_flattened())?;
    }
    encoder.finish()?;
    drop(encoder);
    write!(w, "\n</DataArray>\n")
}
