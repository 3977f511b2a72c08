//! Reads `solution.ply` back, and says what is wrong with a file that is none.
//!
//! Any column may be added to the format: scalar properties and whole elements that are not known
//! here are passed over, and the known ones are found by name, whatever their order and type.

use super::ply_writer::FACE_FLOATS;
use super::{OutputError, SolvedFace, SolvedMesh};
use crate::scene::Side;
use glam::DVec3;
use std::fs;
use std::path::Path;

/// Reads a solution written by [`super::write_ply`].
///
/// # Errors
/// [`OutputError::Io`] where it cannot be read, [`OutputError::Malformed`] with the reason where it
/// is not a solution or not a whole one.
pub fn read_ply(path: &Path) -> Result<SolvedMesh, OutputError> {
    let bytes = fs::read(path).map_err(|e| OutputError::io("read", path, e))?;
    parse(&bytes).map_err(|reason| OutputError::malformed(path, reason))
}

/// A scalar type of PLY, with its older name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn parse(name: &str) -> Result<Self, String> {
        Ok(match name {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return Err(format!("\"{name}\" is no type of a property")),
        })
    }

    /// Every scalar fits an f64 without rounding.
    fn read(self, from: &mut Cursor<'_>) -> Result<f64, String> {
        Ok(match self {
            Self::I8 => f64::from(i8::from_le_bytes(from.take()?)),
            Self::U8 => f64::from(u8::from_le_bytes(from.take()?)),
            Self::I16 => f64::from(i16::from_le_bytes(from.take()?)),
            Self::U16 => f64::from(u16::from_le_bytes(from.take()?)),
            Self::I32 => f64::from(i32::from_le_bytes(from.take()?)),
            Self::U32 => f64::from(u32::from_le_bytes(from.take()?)),
            Self::F32 => f64::from(f32::from_le_bytes(from.take()?)),
            Self::F64 => f64::from_le_bytes(from.take()?),
        })
    }
}

/// A column of an element.
struct Property {
    name: String,
    /// The type of a list's length; `None` for a scalar.
    length: Option<Scalar>,
    value: Scalar,
}

/// A table of the file.
struct Element {
    name: String,
    count: usize,
    properties: Vec<Property>,
}

impl Element {
    /// The place of each wanted scalar among the values of a row.
    fn places<const N: usize>(&self, names: [&str; N]) -> Result<[usize; N], String> {
        let mut places = [0; N];
        for (place, name) in places.iter_mut().zip(names) {
            *place = self
                .properties
                .iter()
                .position(|p| p.name == name && p.length.is_none())
                .ok_or_else(|| format!("its {}s have no property \"{name}\"", self.name))?;
        }
        Ok(places)
    }

    /// Reads one row: a value a property; a list's entries go to `list`.
    fn row(
        &self,
        from: &mut Cursor<'_>,
        values: &mut Vec<f64>,
        list: &mut Vec<f64>,
    ) -> Result<(), String> {
        values.clear();
        list.clear();
        for property in &self.properties {
            let Some(length) = property.length else {
                values.push(property.value.read(from)?);
                continue;
            };
            let length = length.read(from)?;
            if !(0.0..=255.0).contains(&length) {
                return Err(format!("a list of {length} entries"));
            }
            let wanted = property.name == "vertex_indices";
            for _ in 0..length as usize {
                let entry = property.value.read(from)?;
                if wanted {
                    list.push(entry);
                }
            }
            values.push(length);
        }
        Ok(())
    }

    fn is_list(&self, name: &str) -> bool {
        self.properties
            .iter()
            .any(|p| p.name == name && p.length.is_some())
    }
}

/// The unread rest of the file.
struct Cursor<'a> {
    rest: &'a [u8],
}

impl<'a> Cursor<'a> {
    fn take<const N: usize>(&mut self) -> Result<[u8; N], String> {
        let (head, rest) = self
            .rest
            .split_first_chunk::<N>()
            .ok_or_else(|| "the file ends early".to_owned())?;
        self.rest = rest;
        Ok(*head)
    }

    fn line(&mut self) -> Result<&'a str, String> {
        let end = self
            .rest
            .iter()
            .position(|&b| b == b'\n')
            .ok_or("the header has no end")?;
        let (line, rest) = self.rest.split_at(end);
        self.rest = &rest[1..];
        let line = std::str::from_utf8(line).map_err(|_| "the header is not text")?;
        Ok(line.trim_end_matches('\r'))
    }
}

fn parse(bytes: &[u8]) -> Result<SolvedMesh, String> {
    if !bytes.starts_with(b"ply\n") && !bytes.starts_with(b"ply\r\n") {
        return Err("it does not begin with \"ply\"".to_owned());
    }
    let mut cursor = Cursor { rest: bytes };
    let elements = header(&mut cursor)?;
    let mut mesh = SolvedMesh::default();
    for element in &elements {
        // Every row takes a byte at least, so no header can ask for work that the file does not hold.
        if element.count > cursor.rest.len() {
            return Err(at(element, 0, "the file ends early"));
        }
        match element.name.as_str() {
            "vertex" => mesh.vertices = vertices(element, &mut cursor)?,
            "face" => mesh.faces = faces(element, &mut cursor)?,
            _ => {
                let (mut values, mut list) = (Vec::new(), Vec::new());
                for i in 0..element.count {
                    element
                        .row(&mut cursor, &mut values, &mut list)
                        .map_err(|e| at(element, i, &e))?;
                }
            }
        }
    }
    for name in ["vertex", "face"] {
        if !elements.iter().any(|e| e.name == name) {
            return Err(format!("it has no element \"{name}\""));
        }
    }
    if !cursor.rest.is_empty() {
        return Err(format!("{} bytes follow its end", cursor.rest.len()));
    }
    let count = mesh.vertices.len();
    if let Some(face) =
        (mesh.faces.iter()).position(|f| f.vertices.iter().any(|&v| v as usize >= count))
    {
        return Err(format!(
            "face {face} has a vertex beyond the {count} there are"
        ));
    }
    Ok(mesh)
}

fn header(cursor: &mut Cursor<'_>) -> Result<Vec<Element>, String> {
    let mut elements: Vec<Element> = Vec::new();
    let mut format = false;
    cursor.line()?;
    loop {
        let line = cursor.line()?;
        let words: Vec<&str> = line.split_ascii_whitespace().collect();
        match words[..] {
            ["comment" | "obj_info", ..] | [] => {}
            ["format", "binary_little_endian", "1.0"] => format = true,
            ["format", ..] => {
                return Err(format!(
                    "its format is \"{line}\", not binary little endian 1.0"
                ));
            }
            ["element", name, count] => elements.push(Element {
                name: name.to_owned(),
                count: count
                    .parse()
                    .map_err(|_| format!("\"{line}\" does not count anything"))?,
                properties: Vec::new(),
            }),
            ["property", ref rest @ ..] => {
                let (length, value, name) = match *rest {
                    ["list", length, value, name] => (Some(Scalar::parse(length)?), value, name),
                    [value, name] => (None, value, name),
                    _ => return Err(format!("\"{line}\" is no property")),
                };
                elements
                    .last_mut()
                    .ok_or("a property stands before the first element")?
                    .properties
                    .push(Property {
                        name: name.to_owned(),
                        length,
                        value: Scalar::parse(value)?,
                    });
            }
            ["end_header"] if format => return Ok(elements),
            ["end_header"] => return Err("its header names no format".to_owned()),
            _ => return Err(format!("\"{line}\" is no line of a header")),
        }
    }
}

fn at(element: &Element, row: usize, reason: &str) -> String {
    format!("{} {row} of {}: {reason}", element.name, element.count)
}

fn vertices(element: &Element, cursor: &mut Cursor<'_>) -> Result<Vec<DVec3>, String> {
    let places = element.places(["x", "y", "z"])?;
    let (mut values, mut list) = (Vec::new(), Vec::new());
    (0..element.count)
        .map(|i| {
            element
                .row(cursor, &mut values, &mut list)
                .map_err(|e| at(element, i, &e))?;
            let position = DVec3::from_array(places.map(|p| values[p]));
            if !position.is_finite() {
                return Err(at(element, i, "a coordinate is not finite"));
            }
            Ok(position)
        })
        .collect()
}

fn faces(element: &Element, cursor: &mut Cursor<'_>) -> Result<Vec<SolvedFace>, String> {
    if !element.is_list("vertex_indices") {
        return Err("its faces have no list \"vertex_indices\"".to_owned());
    }
    let [source_face, side] = element.places(["source_face", "side"])?;
    let floats = element.places(FACE_FLOATS)?;
    let (mut values, mut list) = (Vec::new(), Vec::new());
    (0..element.count)
        .map(|i| {
            let wrong = |reason: &str| at(element, i, reason);
            element
                .row(cursor, &mut values, &mut list)
                .map_err(|e| wrong(&e))?;
            let &[a, b, c] = list.as_slice() else {
                return Err(wrong("it is not a triangle"));
            };
            let light = floats.map(|p| values[p] as f32);
            if light.iter().any(|x| !x.is_finite()) {
                return Err(wrong("a radiosity or irradiance is not finite"));
            }
            let [br, bg, bb, er, eg, eb] = light;
            let index = |x: f64| index(x).ok_or_else(|| wrong("an index is no whole number"));
            Ok(SolvedFace {
                vertices: [index(a)?, index(b)?, index(c)?],
                source_face: index(values[source_face])?,
                side: match values[side] {
                    0.0 => Side::Front,
                    1.0 => Side::Back,
                    _ => return Err(wrong("its side is neither 0 nor 1")),
                },
                radiosity: [br, bg, bb],
                irradiance: [er, eg, eb],
            })
        })
        .collect()
}

/// A whole number that is not negative and fits 32 bits.
fn index(x: f64) -> Option<u32> {
    (x >= 0.0 && x <= f64::from(u32::MAX) && x.fract() == 0.0).then_some(x as u32)
}
