//! The corners of an element in f64, lane by lane, and the part of it beyond a plane.

use super::bounds::ElementBounds;
use glam::DVec3;

/// Points of a convex set, eight lanes at a time: 8 corners, and 4 x 4 cuts at most.
pub(super) const MOST_POINTS: usize = 24;

/// Corners of an element; lanes beyond the count repeat the last one.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(super) struct WideCorners {
    pub x: [f64; 8],
    pub y: [f64; 8],
    pub z: [f64; 8],
    pub count: usize,
    pub centre: DVec3,
}

/// Heights of the corners over a plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Heights {
    pub of: [f64; 8],
    pub least: f64,
    pub greatest: f64,
}

impl WideCorners {
    #[inline(always)]
    pub(super) fn new(bounds: &ElementBounds) -> Self {
        let mut corners = Self {
            x: [0.0; 8],
            y: [0.0; 8],
            z: [0.0; 8],
            count: bounds.corner_count(),
            centre: bounds.centre().as_dvec3(),
        };
        for l in 0..8 {
            corners.x[l] = f64::from(bounds.x[l]);
            corners.y[l] = f64::from(bounds.y[l]);
            corners.z[l] = f64::from(bounds.z[l]);
        }
        corners
    }

    #[inline(always)]
    pub(super) fn heights(&self, origin: DVec3, normal: DVec3) -> Heights {
        let mut of = [0.0_f64; 8];
        for (l, h) in of.iter_mut().enumerate() {
            *h = normal.x * (self.x[l] - origin.x)
                + normal.y * (self.y[l] - origin.y)
                + normal.z * (self.z[l] - origin.z);
        }
        let (mut least, mut greatest) = (of[0], of[0]);
        for h in of {
            least = if h < least { h } else { least };
            greatest = if h > greatest { h } else { greatest };
        }
        Heights {
            of,
            least,
            greatest,
        }
    }

    #[inline(always)]
    fn point(&self, l: usize) -> DVec3 {
        DVec3::new(self.x[l], self.y[l], self.z[l])
    }
}

/// Points whose hull is an element or a part of it; lanes beyond the count, up to the next multiple
/// of eight, repeat one of them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Points<'a> {
    pub x: &'a [f64],
    pub y: &'a [f64],
    pub z: &'a [f64],
    pub count: usize,
}

impl Points<'_> {
    #[inline(always)]
    pub(super) fn point(&self, l: usize) -> DVec3 {
        DVec3::new(self.x[l], self.y[l], self.z[l])
    }
}

/// Room for the points of a part.
#[derive(Clone, Debug)]
pub(super) struct Part {
    x: [f64; MOST_POINTS],
    y: [f64; MOST_POINTS],
    z: [f64; MOST_POINTS],
    count: usize,
}

impl WideCorners {
    /// The part of the element with `side * height > depth`; `room` holds it where that is not all
    /// of the element.
    #[inline(always)]
    pub(super) fn beyond<'a>(
        &'a self,
        heights: &Heights,
        side: f64,
        depth: f64,
        room: &'a mut Option<Part>,
    ) -> Points<'a> {
        let lowest = if side > 0.0 {
            heights.least
        } else {
            -heights.greatest
        };
        if lowest > depth {
            return Points {
                x: &self.x,
                y: &self.y,
                z: &self.z,
                count: self.count,
            };
        }
        let part = room.insert(Part::cut(self, heights, side, depth));
        Points {
            x: &part.x,
            y: &part.y,
            z: &part.z,
            count: part.count,
        }
    }
}

impl Part {
    /// The corners beyond the plane and the cuts between any corner beyond and any that is not (more
    /// than the hull's edges, the same hull).
    #[inline(always)]
    fn cut(corners: &WideCorners, heights: &Heights, side: f64, depth: f64) -> Self {
        let mut part = Self {
            x: [0.0; MOST_POINTS],
            y: [0.0; MOST_POINTS],
            z: [0.0; MOST_POINTS],
            count: 0,
        };
        for i in 0..corners.count {
            let (p, h) = (corners.point(i), side * heights.of[i]);
            if h <= depth {
                continue;
            }
            part.push(p);
            for k in 0..corners.count {
                let below = side * heights.of[k];
                if below <= depth {
                    part.push(p + (corners.point(k) - p) * ((h - depth) / (h - below)));
                }
            }
        }
        let first = DVec3::new(part.x[0], part.y[0], part.z[0]);
        for l in part.count..part.count.next_multiple_of(8).min(MOST_POINTS) {
            part.set(l, first);
        }
        part
    }

    #[inline(always)]
    fn push(&mut self, point: DVec3) {
        // n corners of 8 beyond: n + n (8 - n) is at most 20.
        self.set(self.count, point);
        self.count += 1;
    }

    #[inline(always)]
    fn set(&mut self, l: usize, point: DVec3) {
        (self.x[l], self.y[l], self.z[l]) = (point.x, point.y, point.z);
    }
}
