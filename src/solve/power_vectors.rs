//! Power times normal of each facet, coordinate by coordinate: what a cluster of any shape sends towards a point.

use glam::Vec3;
use std::ops::Range;

/// Facets that are summed side by side.
const LANES: usize = 8;

/// One vector a facet, in the hierarchy's order: its unit normal times the power that it has yet to shoot, over all
/// channels.
#[derive(Clone, Debug, Default)]
pub struct PowerVectors {
    axes: [Vec<f32>; 3],
}

impl PowerVectors {
    /// Nothing to shoot.
    pub fn zero(facets: usize) -> Self {
        Self {
            axes: [0; 3].map(|_| vec![0.0; facets]),
        }
    }

    /// Sets that of one facet.
    pub fn set(&mut self, facet: usize, vector: Vec3) {
        for (axis, value) in self.axes.iter_mut().zip(vector.to_array()) {
            axis[facet] = value;
        }
    }

    /// Sum over facets of what each sends towards `direction` (of any length): power times the dot product with its
    /// normal, where that is positive.
    pub fn towards(&self, facets: Range<usize>, direction: Vec3) -> f32 {
        let [x, y, z] = [0, 1, 2].map(|axis| &self.axes[axis][facets.clone()]);
        let flux = |x: f32, y: f32, z: f32| {
            let along = x * direction.x + y * direction.y + z * direction.z;
            if along > 0.0 { along } else { 0.0 }
        };
        let mut sums = [0.0f32; LANES];
        let whole = x.len() - x.len() % LANES;
        for at in (0..whole).step_by(LANES) {
            let [x, y, z] = [x, y, z].map(|axis| &axis[at..at + LANES]);
            for l in 0..LANES {
                sums[l] += flux(x[l], y[l], z[l]);
            }
        }
        for at in whole..x.len() {
            sums[at - whole] += flux(x[at], y[at], z[at]);
        }
        sums.iter().sum()
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.axes.iter().map(|axis| size_of_val(&axis[..])).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn facets_that_face_away_send_nothing_and_the_others_their_share() {
        let directions = [Vec3::X, Vec3::new(-0.3, 2.0, 0.7), -Vec3::Z];
        // Every count of facets around a whole number of lanes.
        for count in 0..20 {
            let vector = |i: usize| {
                let t = i as f32;
                Vec3::new((1.3 * t).sin(), (2.1 * t).cos(), (0.7 * t + 1.0).sin()) * (1.0 + t)
            };
            let mut vectors = PowerVectors::zero(count + 3);
            (0..count + 3).for_each(|i| vectors.set(i, vector(i)));
            for direction in directions {
                let want: f64 = (2..count + 2)
                    .map(|i| f64::from(vector(i).dot(direction)).max(0.0))
                    .sum();
                let got = f64::from(vectors.towards(2..count + 2, direction));
                assert!(
                    (got - want).abs() < 1.0e-5 * (1.0 + want),
                    "{got} for {want}"
                );
            }
        }
    }
}
