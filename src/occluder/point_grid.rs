//! A uniform grid over points of the plane, to find those near a point or a segment.

use glam::{DVec2, UVec2};

/// Points in buckets; about one point a bucket.
pub(super) struct PointGrid {
    min: DVec2,
    cell: f64,
    size: UVec2,
    /// Start of each bucket in `points`, and the end of the last.
    starts: Vec<u32>,
    /// Indices of points, ascending within a bucket.
    points: Vec<u32>,
}

impl PointGrid {
    /// A grid over `positions`; answers are indices into it.
    pub fn new(positions: &[DVec2]) -> Self {
        let min = positions.iter().copied().fold(DVec2::INFINITY, DVec2::min);
        let max = positions
            .iter()
            .copied()
            .fold(DVec2::NEG_INFINITY, DVec2::max);
        let count = positions.len().max(1) as f64;
        let extent = (max - min).max(DVec2::ZERO);
        // The second term bounds the buckets of points on one line, the third those of one point.
        let cell = (extent.x * extent.y / count)
            .sqrt()
            .max((extent.x + extent.y) / count)
            .max(1.0e-9);
        let size = (extent / cell).as_uvec2() + UVec2::ONE;
        let mut grid = Self {
            min,
            cell,
            size,
            starts: vec![0; (size.x as usize) * (size.y as usize) + 1],
            points: vec![0; positions.len()],
        };
        let buckets: Vec<usize> = positions
            .iter()
            .map(|&p| grid.bucket(grid.clamp((p - min) / cell)))
            .collect();
        for &bucket in &buckets {
            grid.starts[bucket + 1] += 1;
        }
        for bucket in 1..grid.starts.len() {
            grid.starts[bucket] += grid.starts[bucket - 1];
        }
        let mut next = grid.starts.clone();
        for (point, &bucket) in (0u32..).zip(&buckets) {
            grid.points[next[bucket] as usize] = point;
            next[bucket] += 1;
        }
        grid
    }

    fn clamp(&self, at: DVec2) -> UVec2 {
        at.max(DVec2::ZERO).as_uvec2().min(self.size - UVec2::ONE)
    }

    fn bucket(&self, at: UVec2) -> usize {
        at.y as usize * self.size.x as usize + at.x as usize
    }

    /// Calls `visit` with every point within `radius` of the segment `ab`, and some others.
    pub fn near_segment(&self, a: DVec2, b: DVec2, radius: f64, mut visit: impl FnMut(u32)) {
        let (low, high) = (a.min(b) - radius, a.max(b) + radius);
        let first = self.clamp((low - self.min) / self.cell);
        let last = self.clamp((high - self.min) / self.cell);
        let along = b - a;
        for column in first.x..=last.x {
            let (mut bottom, mut top) = (low.y, high.y);
            // The part of the segment above this column, widened by the radius and by a bit of a
            // cell for rounding, bounds the rows.
            if along.x != 0.0 && first.x != last.x {
                let slack = radius + 1.0e-3 * self.cell;
                let left = self.min.x + f64::from(column) * self.cell - slack;
                let right = left + self.cell + 2.0 * slack;
                let at = |x: f64| a.y + ((x - a.x) / along.x).clamp(0.0, 1.0) * along.y;
                // Points beyond the grid's sides live in its outer columns.
                let left = if column == 0 { low.x } else { left };
                let right = if column + 1 == self.size.x {
                    high.x
                } else {
                    right
                };
                bottom = at(left).min(at(right)) - slack;
                top = at(left).max(at(right)) + slack;
            }
            let row = |y: f64| {
                ((y - self.min.y) / self.cell).clamp(0.0, f64::from(self.size.y - 1)) as u32
            };
            for row in row(bottom)..=row(top) {
                let bucket = self.bucket(UVec2::new(column, row));
                let range = self.starts[bucket] as usize..self.starts[bucket + 1] as usize;
                self.points[range].iter().for_each(|&p| visit(p));
            }
        }
    }
}
