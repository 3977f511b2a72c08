//! What the corners of an OBJ file's faces refer to: counted from the front, or back from the face; elements may also
//! follow the face that names them.

use super::error::{DefectLog, Reason};
use super::statement::decode;

/// The lists that a corner refers to, in the order of the corner's parts.
#[derive(Clone, Copy)]
pub(super) enum List {
    Vertex,
    TextureCoordinate,
    Normal,
}

impl List {
    const ALL: [Self; 3] = [Self::Vertex, Self::TextureCoordinate, Self::Normal];

    fn name(self) -> &'static str {
        match self {
            Self::Vertex => "vertex",
            Self::TextureCoordinate => "texture coordinate",
            Self::Normal => "normal",
        }
    }
}

/// A positive index beyond what had been read when it was met; the element may still follow.
struct Forward {
    line: usize,
    list: List,
    index: i64,
}

/// The elements read so far, and what was said of those to come.
#[derive(Default)]
pub(super) struct CornerIndices {
    counts: [usize; 3],
    forward: Vec<Forward>,
}

impl CornerIndices {
    /// One more element of a list.
    pub fn add(&mut self, list: List) {
        self.counts[list as usize] += 1;
    }

    /// Elements of a list read so far.
    pub fn count(&self, list: List) -> usize {
        self.counts[list as usize]
    }

    /// A corner's vertex and texture coordinate as absolute 1-based indices.
    pub fn corner(
        &mut self,
        word: &[u8],
        line: usize,
        defects: &mut DefectLog,
    ) -> Option<(i64, Option<i64>)> {
        let Some(written) = corner_parts(word) else {
            defects.add(Some(line), Reason::BadCorner(decode(word)));
            return None;
        };
        let mut absolute = [None; 3];
        let mut sound = true;
        for (list, index) in List::ALL.into_iter().zip(written) {
            if let Some(index) = index {
                absolute[list as usize] = self.resolve(list, index, line, defects);
                sound &= absolute[list as usize].is_some();
            }
        }
        let vertex = absolute[List::Vertex as usize]?;
        sound.then_some((vertex, absolute[List::TextureCoordinate as usize]))
    }

    fn resolve(
        &mut self,
        list: List,
        index: i64,
        line: usize,
        defects: &mut DefectLog,
    ) -> Option<i64> {
        let count = self.count(list);
        // Counts are bounded by the file's length, which fits i64.
        let signed_count = count as i64;
        if index > signed_count {
            self.forward.push(Forward { line, list, index });
            Some(index)
        } else if index > 0 {
            Some(index)
        } else if index < 0 && index >= -signed_count {
            Some(signed_count + index + 1)
        } else {
            defects.add(Some(line), out_of_range(list, index, count));
            None
        }
    }

    /// At the end of the file: notes what was referred to and never came.
    pub fn finish(&mut self, defects: &mut DefectLog) {
        for Forward { line, list, index } in std::mem::take(&mut self.forward) {
            let count = self.count(list);
            if index > count as i64 {
                defects.add(Some(line), out_of_range(list, index, count));
            }
        }
    }
}

/// The indices of `v`, `v/vt`, `v//vn` or `v/vt/vn` as written; a part other than the first may be
/// left out.
fn corner_parts(word: &[u8]) -> Option<[Option<i64>; 3]> {
    let mut written = [None; 3];
    for (list, part) in word.split(|&b| b == b'/').enumerate() {
        let slot = written.get_mut(list)?;
        if !part.is_empty() {
            *slot = Some(std::str::from_utf8(part).ok()?.parse().ok()?);
        }
    }
    written[0].map(|_| written)
}

fn out_of_range(list: List, index: i64, count: usize) -> Reason {
    Reason::IndexOutOfRange {
        kind: list.name(),
        index,
        count,
    }
}
