//! Writes `solution.glb`: glTF 2.0 (Khronos Group 2021) as one binary file, for viewers and modelling programs.
//!
//! Colours stand at the vertices, interpolated as in a smooth view and tone-mapped; the material is unlit, so that a
//! viewer adds no light of its own. Each side of a face shows on its side only: rooms can be looked into from outside.

use super::panel::Panels;
use super::panel_reflectance::reflectance;
use super::smoothing::Smoothing;
use super::{OutputError, SolvedMesh, ToneMap, UpAxis, write_atomically};
use glam::DVec3;
use serde_json::{Value, json};
use std::collections::HashMap;
use std::io::{self, Write};
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// Numbers that the format names: component types, targets of buffers, chunk types.
const FLOAT: u32 = 5126;
const UNSIGNED_SHORT: u32 = 5123;
const UNSIGNED_INT: u32 = 5125;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;
const MAGIC: &[u8; 4] = b"glTF";
const JSON_CHUNK: &[u8; 4] = b"JSON";
const BINARY_CHUNK: &[u8; 4] = b"BIN\0";

/// Bytes of a vertex's position, of its colour (red, green, blue and alpha, for alignment), and of an index.
const POSITION_BYTES: usize = 12;
const COLOUR_BYTES: usize = 8;
const INDEX_BYTES: usize = 4;

/// The vertices of the file: a corner of the mesh for every colour that it has.
struct Vertices {
    positions: Vec<[f32; 3]>,
    colours: Vec<[u16; 4]>,
    indices: Vec<u32>,
    /// What positions are relative to, in the file's units, turned as they are.
    centre: DVec3,
    tone_map: ToneMap,
}

/// Writes the mesh to `path`, whole or not at all, turned so that `up` becomes +y, which is up in glTF. Positions are rounded to f32 about the middle of the scene, where the
/// node's translation puts them back.
///
/// # Errors
/// As [`write_atomically`], and [`OutputError::TooLarge`].
pub fn write_glb(
    path: &Path,
    mesh: &SolvedMesh,
    up: UpAxis,
    interrupted: &AtomicBool,
) -> Result<(), OutputError> {
    let vertices = Vertices::of(mesh, up);
    let bytes = vertices.bytes();
    if i32::try_from(bytes).is_err() {
        return Err(OutputError::TooLarge {
            path: path.to_path_buf(),
            what: "bytes",
            count: bytes,
        });
    }
    write_atomically(path, interrupted, |w| {
        vertices
            .encode(w)
            .map_err(|e| OutputError::io("write", path, e))
    })
}

impl Vertices {
    fn of(mesh: &SolvedMesh, up: UpAxis) -> Self {
        let panels = Panels::new(mesh);
        let smoothing = Smoothing::new(mesh, &panels);
        let (least, greatest) = panels.positions.iter().fold(
            (DVec3::INFINITY, DVec3::NEG_INFINITY),
            |(least, greatest), &p| (least.min(p), greatest.max(p)),
        );
        let middle = if mesh.faces.is_empty() {
            DVec3::ZERO
        } else {
            0.5 * least + 0.5 * greatest
        };
        let mut vertices = Self {
            positions: Vec::new(),
            colours: Vec::new(),
            indices: Vec::with_capacity(3 * mesh.faces.len()),
            centre: up.turned_to_y(middle),
            tone_map: ToneMap::automatic(mesh.faces.iter().map(|f| (f.radiosity, mesh.area(f)))),
        };
        let slopes: Vec<[f32; 3]> = (panels.panels.iter())
            .map(|panel| reflectance(mesh, &panels, panel))
            .collect();
        let mut index: HashMap<(u32, [u16; 4]), u32> = HashMap::new();
        for (l, (leaf, face)) in panels.leaves.iter().zip(&mesh.faces).enumerate() {
            for (corner, &vertex) in leaf.corners.iter().enumerate() {
                let mut weights = [0.0; 3];
                weights[corner] = 1.0;
                let irradiance = smoothing.irradiance(l, weights);
                let slope = slopes[leaf.panel as usize];
                let radiosity: [f32; 3] = std::array::from_fn(|c| {
                    let more = irradiance[c] as f32 - face.irradiance[c];
                    (face.radiosity[c] + slope[c] * more).max(0.0)
                });
                let [r, g, b] = (vertices.tone_map.display(radiosity))
                    .map(|x| (f64::from(x) * f64::from(u16::MAX) + 0.5) as u16);
                let colour = [r, g, b, u16::MAX];
                let id = *index.entry((vertex, colour)).or_insert_with(|| {
                    let position = panels.positions[vertex as usize] - middle;
                    let turned = up.turned_to_y(position).as_vec3();
                    vertices.positions.push(turned.to_array());
                    vertices.colours.push(colour);
                    vertices.positions.len() as u32 - 1
                });
                vertices.indices.push(id);
            }
        }
        vertices
    }

    fn bytes(&self) -> usize {
        self.positions.len() * (POSITION_BYTES + COLOUR_BYTES) + self.indices.len() * INDEX_BYTES
    }

    fn encode(&self, w: &mut impl Write) -> io::Result<()> {
        // Chunks are whole words: JSON is filled up with spaces; the numbers need no filling.
        let mut json = self.document().to_string().into_bytes();
        json.resize(json.len().next_multiple_of(4), b' ');
        let binary = self.bytes();
        let chunks = 8 + json.len() + if binary > 0 { 8 + binary } else { 0 };
        w.write_all(MAGIC)?;
        w.write_all(&2u32.to_le_bytes())?;
        w.write_all(&(12 + chunks as u32).to_le_bytes())?;
        w.write_all(&(json.len() as u32).to_le_bytes())?;
        w.write_all(JSON_CHUNK)?;
        w.write_all(&json)?;
        if binary == 0 {
            return Ok(());
        }
        w.write_all(&(binary as u32).to_le_bytes())?;
        w.write_all(BINARY_CHUNK)?;
        for x in self.positions.as_flattened() {
            w.write_all(&x.to_le_bytes())?;
        }
        for x in self.colours.as_flattened() {
            w.write_all(&x.to_le_bytes())?;
        }
        for x in &self.indices {
            w.write_all(&x.to_le_bytes())?;
        }
        Ok(())
    }

    /// The JSON part.
    fn document(&self) -> Value {
        let generator = concat!("certilux ", env!("CARGO_PKG_VERSION"));
        let asset = json!({ "version": "2.0", "generator": generator });
        if self.indices.is_empty() {
            return json!({ "asset": asset, "scene": 0, "scenes": [{ "nodes": [0] }], "nodes": [{ "name": "solution" }] });
        }
        let (least, greatest) = self.positions.iter().fold(
            ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]),
            |(least, greatest): ([f32; 3], [f32; 3]), p| {
                let of =
                    |f: fn(f32, f32) -> f32, a: [f32; 3]| std::array::from_fn(|i| f(a[i], p[i]));
                (of(f32::min, least), of(f32::max, greatest))
            },
        );
        let positions = self.positions.len() * POSITION_BYTES;
        let colours = self.colours.len() * COLOUR_BYTES;
        let indices = self.indices.len() * INDEX_BYTES;
        json!({
            "asset": asset,
            "extensionsUsed": ["KHR_materials_unlit"],
            "scene": 0,
            "scenes": [{ "name": "solution", "nodes": [0] }],
            "nodes": [{ "name": "solution", "mesh": 0, "translation": self.centre.to_array() }],
            "meshes": [{
                "name": "solution",
                "primitives": [{
                    "attributes": { "POSITION": 0, "COLOR_0": 1 },
                    "indices": 2,
                    "material": 0,
                    "mode": 4
                }],
                // What radiosity was multiplied by before the filmic curve.
                "extras": { "exposure": self.tone_map.scale() }
            }],
            "materials": [{
                "name": "radiosity",
                "pbrMetallicRoughness": { "metallicFactor": 0.0, "roughnessFactor": 1.0 },
                "extensions": { "KHR_materials_unlit": {} }
            }],
            "accessors": [
                { "bufferView": 0, "componentType": FLOAT, "count": self.positions.len(), "type": "VEC3",
                  "min": least, "max": greatest },
                { "bufferView": 1, "componentType": UNSIGNED_SHORT, "normalized": true, "count": self.colours.len(),
                  "type": "VEC4" },
                { "bufferView": 2, "componentType": UNSIGNED_INT, "count": self.indices.len(), "type": "SCALAR" }
            ],
            "bufferViews": [
                { "buffer": 0, "byteOffset": 0, "byteLength": positions, "target": ARRAY_BUFFER },
                { "buffer": 0, "byteOffset": positions, "byteLength": colours, "target": ARRAY_BUFFER },
                { "buffer": 0, "byteOffset": positions + colours, "byteLength": indices, "target": ELEMENT_ARRAY_BUFFER }
            ],
            "buffers": [{ "byteLength": self.bytes() }]
        })
    }
}
