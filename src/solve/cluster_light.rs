//! What a flat cluster has gathered: an irradiance vector for its facets' normals, and how the irradiance changes
//! along its plane.
//!
//! One vector alone would leave the same light on both ends of a cluster: of four facets in a corner of a finely meshed
//! room the outer ones were 4 % too bright and their neighbours 1.4 % too dark (`bench/runs/`, accuracy/clusters.md).

use glam::{DVec3, Vec3};

/// One channel of it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ClusterLight {
    /// Its dot product with a facet's normal is the irradiance there, were it even.
    pub vector: DVec3,
    /// What the irradiance gains along each axis.
    slope: DVec3,
    /// `slope . p + offset` is what a point has more than an even light.
    offset: f64,
}

impl ClusterLight {
    /// Nothing.
    pub const ZERO: Self = Self {
        vector: DVec3::ZERO,
        slope: DVec3::ZERO,
        offset: 0.0,
    };

    /// The light `vector` at `centroid`, and from there with `slope`.
    pub fn about(centroid: Vec3, vector: Vec3, slope: Vec3) -> Self {
        let slope = slope.as_dvec3();
        Self {
            vector: vector.as_dvec3(),
            slope,
            offset: -slope.dot(centroid.as_dvec3()),
        }
    }

    /// Adds `factor` times another.
    pub fn add(&mut self, other: &Self, factor: f64) {
        self.vector += other.vector * factor;
        self.slope += other.slope * factor;
        self.offset += other.offset * factor;
    }

    /// The irradiance at the corners of a facet. Its mean is not below zero: a cluster receives only what is in front of
    /// all its facets, so that less is rounding, or second sets of samples that took back more than the others brought.
    pub fn on_facet(&self, corners: [Vec3; 3], normal: Vec3) -> [f64; 3] {
        let even = normal.as_dvec3().dot(self.vector);
        let beyond = corners.map(|p| self.slope.dot(p.as_dvec3()) + self.offset);
        let mean = even + (beyond[0] + beyond[1] + beyond[2]) / 3.0;
        beyond.map(|x| even + x + (mean.max(0.0) - mean))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [Vec3; 3] = [
        Vec3::new(1.0, 0.0, 0.5),
        Vec3::new(3.0, 0.0, 0.5),
        Vec3::new(1.0, 4.0, 0.5),
    ];

    #[test]
    fn light_is_linear_about_the_centroid_and_adds_up() {
        let centroid = Vec3::new(2.0, 1.0, 0.5);
        let one = ClusterLight::about(centroid, Vec3::new(0.3, 0.0, 2.0), Vec3::new(0.5, 0.0, 0.0));
        let two = ClusterLight::about(centroid, Vec3::ZERO, Vec3::new(0.0, 0.25, 0.0));
        let mut sum = ClusterLight::ZERO;
        sum.add(&one, 2.0);
        sum.add(&two, 4.0);
        // 4 + (x - 2) + (y - 1).
        let got = sum.on_facet(CORNERS, Vec3::Z);
        for (got, want) in got.into_iter().zip([2.0, 4.0, 6.0]) {
            assert!((got - want).abs() < 1.0e-6, "{got} for {want}");
        }
    }

    #[test]
    fn no_facet_has_a_mean_below_zero() {
        let middle = (CORNERS[0] + CORNERS[1] + CORNERS[2]) / 3.0;
        let dark = ClusterLight::about(middle, Vec3::new(0.0, 0.0, -1.0), Vec3::X);
        let got = dark.on_facet(CORNERS, Vec3::Z);
        assert!(got.iter().sum::<f64>().abs() < 1.0e-6, "{got:?}");
        assert!((got[1] - got[0] - 2.0).abs() < 1.0e-12, "{got:?}");
    }
}
