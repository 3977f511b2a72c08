//! The bounding box of a file's vertices.

use super::error::Reason;
use glam::DVec3;

/// Spans within which neither squares of areas nor their sums leave the range of f64, whose exponents reach to about
/// +-308: an area is at least 1e-15 of the span's square, so its own square is above 1e-270.
const SPAN_RANGE: std::ops::RangeInclusive<f64> = 1e-60..=1e60;

/// The bounding box of a file's vertices, in its units.
#[derive(Clone, Copy, Debug)]
pub(super) struct FileBox {
    pub centre: DVec3,
    /// Its greatest extent: normal, positive, and f64 holds its fourth power.
    pub span: f64,
}

impl FileBox {
    /// The box of `positions`.
    ///
    /// # Errors
    /// If it has no extent, or one in which f64 cannot square areas.
    pub fn around(positions: &[DVec3]) -> Result<Self, Reason> {
        let (centre, span) = centre_and_span(positions.iter().copied());
        if !SPAN_RANGE.contains(&span) {
            return Err(Reason::SpanOutOfRange(span));
        }
        Ok(Self { centre, span })
    }
}

/// Centre and greatest extent of the bounding box of `points`.
pub(super) fn centre_and_span(points: impl Iterator<Item = DVec3>) -> (DVec3, f64) {
    let (min, max) = points.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(min, max), p| {
        (min.min(p), max.max(p))
    });
    // Halved first: the sum of two coordinates may overflow.
    (min * 0.5 + max * 0.5, (max - min).max_element())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn absurd_spans_are_refused() {
        for side in [0.0, 1e-61, 1e61, f64::MAX] {
            assert!(FileBox::around(&[DVec3::splat(-side), DVec3::splat(side)]).is_err());
        }
    }
}
