//! Where a piece of furniture stands.
//!
//! Pieces are built standing on z = 0 around the origin, their backs towards +y.

use glam::{DVec3, dvec3};

/// A turn about the vertical axis, then a shift.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Where the piece's origin goes, in metres.
    pub position: DVec3,
    cosine: f64,
    sine: f64,
}

impl Placement {
    /// Leaves everything where it is.
    pub const IDENTITY: Self = Self {
        position: DVec3::ZERO,
        cosine: 1.0,
        sine: 0.0,
    };

    /// At `(x, y, z)`, turned counter-clockwise (seen from above) by `degrees`.
    pub fn new(x: f64, y: f64, z: f64, degrees: f64) -> Self {
        // Quarter turns are exact, so that furniture along a wall stays parallel to it.
        let (sine, cosine) = match degrees.rem_euclid(360.0) {
            0.0 => (0.0, 1.0),
            90.0 => (1.0, 0.0),
            180.0 => (0.0, -1.0),
            270.0 => (-1.0, 0.0),
            other => other.to_radians().sin_cos(),
        };
        Self {
            position: dvec3(x, y, z),
            cosine,
            sine,
        }
    }

    /// On the floor (z = 0) at `(x, y)`, turned by `degrees`.
    pub fn on_floor(x: f64, y: f64, degrees: f64) -> Self {
        Self::new(x, y, 0.0, degrees)
    }

    /// The placed position of a point of the piece.
    pub fn apply(&self, p: DVec3) -> DVec3 {
        self.position
            + dvec3(
                self.cosine * p.x - self.sine * p.y,
                self.sine * p.x + self.cosine * p.y,
                p.z,
            )
    }

    /// The placement of a piece that stands at `inner` in the frame of this one.
    #[must_use]
    pub fn then(&self, inner: Self) -> Self {
        Self {
            position: self.apply(inner.position),
            cosine: self.cosine * inner.cosine - self.sine * inner.sine,
            sine: self.sine * inner.cosine + self.cosine * inner.sine,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quarter_turn_takes_the_back_from_north_to_west() {
        let placed = Placement::new(1.0, 2.0, 0.0, 90.0).apply(dvec3(0.0, 1.0, 0.5));
        assert_eq!(placed, dvec3(0.0, 2.0, 0.5));
    }

    #[test]
    fn nested_placements_apply_from_the_inside_out() {
        let outer = Placement::new(3.0, -1.0, 0.2, 37.0);
        let inner = Placement::new(0.5, 0.25, 0.1, 90.0);
        let point = dvec3(0.3, 0.7, 0.9);
        let gap = outer.then(inner).apply(point) - outer.apply(inner.apply(point));
        assert!(gap.length() < 1e-14);
    }
}
