//! What can be wrong with an input file: every defect with its file, its line and its reason.

use super::config::CLAMPED_REFLECTANCE;
use std::fmt;
use thiserror::Error;

/// Greatest `Ke`: its radiosity pi Ke stays in f32 (3.4e38) after reflections worth a factor of 1e4.
pub const MAX_EMISSION: f64 = 1.0e34;

/// Least `Ke` of a scene's brightest surface: a hundredth of a millionth of it still is a normal number in f32 (1.2e-38).
pub const MIN_EMISSION: f64 = 1.0e-30;

/// Largest number of vertices, texture coordinates, faces or polygons in a scene: both sides of
/// every polygon must be countable in 32 bits.
pub const MAX_ELEMENTS: usize = 1 << 31;

/// Why a line, a face or a file is refused.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum Reason {
    /// Nothing stands at the path.
    #[error("there is no such file")]
    Missing,
    /// The path is empty.
    #[error("an OBJ file is needed, and its name is empty")]
    Nameless,
    /// The path is a directory.
    #[error("is a directory, not a file")]
    Directory,
    /// A link that leads nowhere.
    #[error("is a link to a file that does not exist")]
    DanglingLink,
    /// A pipe, a device or a socket, which may never end.
    #[error("is a pipe or a device; a regular file is needed")]
    NotAFile,
    /// The operating system refused to read it.
    #[error("cannot be read: {0}")]
    Unreadable(String),
    /// Nothing but white space and comments.
    #[error("is empty: an OBJ file with vertices (`v`) and faces (`f`) is needed")]
    Empty,
    /// The content is something else.
    #[error("is not an OBJ file: {0}")]
    NotObj(&'static str),
    /// Vertices without faces.
    #[error("has no faces (`f` statements): there is no surface to light")]
    NoFaces,
    /// A number that does not parse.
    #[error("`{0}` is not a number")]
    NotANumber(String),
    /// NaN, an infinity, or a number beyond the range of f64.
    #[error("`{0}` is not a finite number")]
    NotFinite(String),
    /// Too few or too many values after a keyword.
    #[error("`{keyword}` takes {expected}, found {found}")]
    Arity {
        /// The statement.
        keyword: String,
        /// What it takes, in words.
        expected: &'static str,
        /// How many values stand there.
        found: usize,
    },
    /// A vertex whose fourth coordinate divides by zero.
    #[error("the weight w of a vertex must not be 0")]
    ZeroWeight,
    /// A corner that is not `v`, `v/vt`, `v//vn` or `v/vt/vn`.
    #[error("`{0}` is not a corner of a face (v, v/vt, v//vn or v/vt/vn)")]
    BadCorner(String),
    /// A reference to an element that does not exist.
    #[error("{kind} index {index} is out of range: {}", range(*.count))]
    IndexOutOfRange {
        /// Which list: vertex, texture coordinate or normal.
        kind: &'static str,
        /// The index as written.
        index: i64,
        /// Elements that can be referred to from there.
        count: usize,
    },
    /// A keyword that needs a name stands alone.
    #[error("`{0}` needs a name")]
    MissingName(String),
    /// A colour given by a spectrum file or in CIE XYZ.
    #[error("`{0}`: only colours given as numbers (red, green, blue) are supported")]
    UnsupportedColour(String),
    /// A material statement before the first `newmtl`.
    #[error("`{0}` stands before the first `newmtl`")]
    NoMaterialYet(String),
    /// A reflectance or an emission below zero.
    #[error("material `{material}`: {keyword} {} must not be negative", colour(.value))]
    Negative {
        /// The material.
        material: String,
        /// `Kd` or `Ke`.
        keyword: &'static str,
        /// The values.
        value: [f64; 3],
    },
    /// Light that the results cannot hold.
    #[error("material `{material}`: Ke {} is above {MAX_EMISSION:e}, the most that results in f32 can hold", colour(.value))]
    EmissionTooHigh {
        /// The material.
        material: String,
        /// The values.
        value: [f64; 3],
    },
    /// A scene too dark for results to hold its light.
    #[error(
        "the brightest surface emits {0:e}, less than {MIN_EMISSION:e}: results in f32 would lose its light (choose another \
         unit for Ke)"
    )]
    EmissionTooLow(f64),
    /// A reflectance of one or more, with which light would never die out.
    #[error(
        "material `{material}`: Kd {}{} reflects all light or more; every channel must be below 1 \
         (change it, or pass --clamp-reflectance to go on with {})",
        colour(.value),
        texture_note(.texture),
        CLAMPED_REFLECTANCE
    )]
    ReflectanceTooHigh {
        /// The material.
        material: String,
        /// The values, texture included.
        value: [f64; 3],
        /// The texture that has a part in it.
        texture: Option<String>,
    },
    /// Nothing shines.
    #[error(
        "nothing emits light{}: give the material of at least one face an emitted radiance, \
         for example `Ke 10 10 10`, in the MTL file",
        library_note(*.names_library, .missing_libraries)
    )]
    NoEmitter {
        /// Material libraries that the file names but that could not be read.
        missing_libraries: Vec<String>,
        /// Whether it names any.
        names_library: bool,
    },
    /// Emitting faces existed but all were dropped.
    #[error(
        "nothing emits light: all {0} emitting faces were dropped (zero area or duplicates of faces that do not emit)"
    )]
    EmittersDropped(usize),
    /// Every face was dropped.
    #[error("none of its {0} faces has an area: there is no surface to light")]
    NoArea(usize),
    /// Vertices so far apart that single precision cannot tell polygons' corners apart.
    #[error(
        "the vertices span {span:e} units, at which {faces} of {total} faces collapse in single precision \
         (the first is here, the farthest vertex is {farthest:?}): remove what lies far off, or split the scene"
    )]
    Collapsed {
        /// Longest side of the bounding box in the file's units.
        span: f64,
        /// Faces that would vanish.
        faces: usize,
        /// All faces.
        total: usize,
        /// The vertex farthest from the others' mean, in the file's units.
        farthest: [f64; 3],
    },
    /// Coordinates that f64 cannot be trusted with.
    #[error(
        "the vertices span {0:e} units: lengths must lie between 1e-60 and 1e60 for areas and their squares to be computable"
    )]
    SpanOutOfRange(f64),
    /// More elements than 32-bit ids can name.
    #[error("has {count} {kind}, more than the {MAX_ELEMENTS} that can be handled")]
    TooMany {
        /// What there is too much of.
        kind: &'static str,
        /// How many.
        count: usize,
    },
    /// `tobj` refused text that had passed every check of ours.
    #[error("cannot be parsed: {0}")]
    Parser(String),
}

/// One defect: where, and why.
#[derive(Clone, Debug, PartialEq)]
pub struct Defect {
    /// The OBJ or MTL file, or texture.
    pub file: String,
    /// 1-based line, where the defect belongs to one.
    pub line: Option<usize>,
    /// What is wrong.
    pub reason: Reason,
}

impl fmt::Display for Defect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.line {
            Some(line) => write!(f, "{}:{}: {}", self.file, line, self.reason),
            None if self.file.is_empty() => write!(f, "{}", self.reason),
            None => write!(f, "{}: {}", self.file, self.reason),
        }
    }
}

/// All defects of an input, never empty, in the order OBJ, MTL, scene, and by line within each.
#[derive(Clone, Debug, PartialEq, Error)]
pub struct LoadError {
    /// The defects.
    pub defects: Vec<Defect>,
}

impl LoadError {
    /// Lines that [`fmt::Display`] prints before it only counts: a screenful.
    pub const LINES_SHOWN: usize = 50;

    /// The error of a single defect.
    pub(super) fn one(file: &str, line: Option<usize>, reason: Reason) -> Self {
        Self {
            defects: vec![Defect {
                file: file.to_owned(),
                line,
                reason,
            }],
        }
    }
}

impl fmt::Display for LoadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, defect) in self.defects.iter().take(Self::LINES_SHOWN).enumerate() {
            if i > 0 {
                writeln!(f)?;
            }
            write!(f, "{defect}")?;
        }
        if self.defects.len() > Self::LINES_SHOWN {
            write!(f, "\nand {} more", self.defects.len() - Self::LINES_SHOWN)?;
        }
        Ok(())
    }
}

/// Where defects of one file are gathered.
pub(super) struct DefectLog<'a> {
    file: &'a str,
    /// Where this file's defects begin.
    start: usize,
    defects: &'a mut Vec<Defect>,
}

impl<'a> DefectLog<'a> {
    pub(super) fn new(file: &'a str, defects: &'a mut Vec<Defect>) -> Self {
        Self {
            file,
            start: defects.len(),
            defects,
        }
    }

    /// Orders the defects by line, those of the whole file last.
    pub(super) fn sort_by_line(&mut self) {
        self.defects[self.start..].sort_by_key(|d| d.line.unwrap_or(usize::MAX));
    }

    pub(super) fn add(&mut self, line: Option<usize>, reason: Reason) {
        self.defects.push(Defect {
            file: self.file.to_owned(),
            line,
            reason,
        });
    }
}

fn range(count: usize) -> String {
    match count {
        0 => "the file has none at that point (indices start at 1)".to_owned(),
        1 => "only 1 and -1 are valid there".to_owned(),
        n => format!("1 to {n} and -1 to -{n} are valid there"),
    }
}

/// As in an MTL file; numbers that would be hundreds of digits long have exponents.
fn colour(value: &[f64; 3]) -> String {
    let short = 1.0e-5..1.0e15;
    let text = |x: f64| match x == 0.0 || short.contains(&x.abs()) {
        true => format!("{x}"),
        false => format!("{x:e}"),
    };
    value.map(text).join(" ")
}

fn texture_note(texture: &Option<String>) -> String {
    texture
        .as_ref()
        .map_or_else(String::new, |t| format!(" (with texture `{t}`)"))
}

fn library_note(names_library: bool, missing: &[String]) -> String {
    if !names_library {
        " (the file names no material library, as `mtllib NAME.mtl` would)".into()
    } else if missing.is_empty() {
        String::new()
    } else {
        format!(
            " (the material library {} could not be read)",
            missing.join(", ")
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_of_any_size_are_short() {
        assert_eq!(colour(&[0.0, 0.25, 100.0]), "0 0.25 100");
        assert_eq!(colour(&[1.0e300, -2.5e-9, 1.0e15]), "1e300 -2.5e-9 1e15");
    }

    #[test]
    fn display_is_one_line_a_defect_and_is_cut() {
        let defect = |line| Defect {
            file: "a.obj".into(),
            line: Some(line),
            reason: Reason::ZeroWeight,
        };
        let error = LoadError {
            defects: (1..=53).map(defect).collect(),
        };
        let text = error.to_string();
        let lines: Vec<_> = text.lines().collect();
        assert_eq!(lines.len(), 51);
        assert_eq!(lines[0], "a.obj:1: the weight w of a vertex must not be 0");
        assert_eq!(lines[50], "and 3 more");
    }
}
