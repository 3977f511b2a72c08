//! What is left of a side of a polygon when parts of its plane are taken away.

use super::convex::{area, perimeter, split};
use super::flat::Flat;
use glam::DVec2;

/// Pieces into which the uncovered rest of a polygon may fall before it counts as partly covered.
const MOST_PIECES: usize = 256;

/// How much of a side others own.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) enum Covered {
    #[default]
    No,
    /// With the covered area.
    Partly(f64),
    Wholly,
}

/// What is left of a side after others have taken their parts.
pub(super) struct Rest {
    /// Convex, counter-clockwise.
    pub pieces: Vec<Vec<DVec2>>,
    whole: f64,
    /// Strips narrower than twice this are the rounding of shared edges.
    width: f64,
    too_many: bool,
}

impl Rest {
    /// All of a polygon's side.
    pub fn new(own: &Flat, tau: f32) -> Self {
        Self {
            pieces: vec![own.corners.to_vec()],
            whole: area(&own.corners),
            width: f64::from(tau),
            too_many: false,
        }
    }

    /// Takes a convex polygon away; false where that takes nothing more.
    pub fn subtract(&mut self, cutter: &[DVec2]) -> bool {
        if self.too_many
            || !self
                .pieces
                .iter()
                .any(|p| self.matters(&split(p, cutter).0))
        {
            return false;
        }
        let mut left = Vec::new();
        for piece in &self.pieces {
            let (_, outside) = split(piece, cutter);
            left.extend(outside.into_iter().filter(|p| self.matters(p)));
        }
        self.pieces = left;
        self.too_many = self.pieces.len() > MOST_PIECES;
        true
    }

    /// Whether a part is more than a strip along an edge.
    fn matters(&self, piece: &[DVec2]) -> bool {
        area(piece) > self.width * perimeter(piece)
    }

    /// How much of it others have.
    pub fn judge(&self) -> Covered {
        let left: f64 = self.pieces.iter().map(|p| area(p)).sum();
        if self.pieces.is_empty() {
            Covered::Wholly
        } else if left < self.whole * (1.0 - 1e-9) {
            Covered::Partly(self.whole - left)
        } else {
            Covered::No
        }
    }
}
