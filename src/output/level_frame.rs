//! What a level camera sees of the directions around its eye.

use super::up_axis::UpAxis;
use crate::embree::Ray;
use glam::{DVec3, Vec3};

/// Directions around the vertical.
pub(super) const AZIMUTHS: usize = 24;

/// Vertical angle of view in degrees: wide, as interiors are photographed.
pub(super) const ANGLE_OF_VIEW: f64 = 60.0;

/// Rays across and down a coarse picture.
const LOOK: [usize; 2] = [16, 10];

/// The frame of a level camera, wherever it stands and looks.
pub(super) struct LevelFrame {
    up: DVec3,
    /// Two horizontal axes.
    axes: [DVec3; 2],
    /// Half width and half height at distance 1.
    half: [f64; 2],
}

impl LevelFrame {
    /// Of a picture so many times as wide as high.
    pub fn new(up: UpAxis, aspect: f64) -> Self {
        let half_height = (0.5 * ANGLE_OF_VIEW.to_radians()).tan();
        Self {
            up: up.direction(),
            axes: up.level(),
            half: [aspect * half_height, half_height],
        }
    }

    /// A direction of view: its horizontal part has length 1.
    pub fn forward(&self, azimuth: usize, slope: f64) -> DVec3 {
        let angle = std::f64::consts::TAU * azimuth as f64 / AZIMUTHS as f64;
        self.axes[0] * angle.cos() + self.axes[1] * angle.sin() + self.up * slope
    }

    /// Unit forward, right and up of a view.
    fn basis(&self, forward: DVec3) -> [DVec3; 3] {
        let forward = forward.normalize();
        let right = forward.cross(self.up).normalize();
        [forward, right, right.cross(forward)]
    }

    /// How many of the directions lie in the frame.
    pub fn count(&self, forward: DVec3, directions: &[DVec3]) -> usize {
        let [forward, right, up] = self.basis(forward);
        (directions.iter())
            .filter(|d| {
                let depth = d.dot(forward);
                d.dot(right).abs() <= self.half[0] * depth
                    && d.dot(up).abs() <= self.half[1] * depth
            })
            .count()
    }

    /// A coarse picture's rays, of unit depth.
    pub fn look(&self, eye: DVec3, forward: DVec3) -> Vec<Ray> {
        let [forward, right, up] = self.basis(forward);
        let eye: Vec3 = eye.as_vec3();
        let place = |i: usize, n: usize| 2.0 * (i as f64 + 0.5) / n as f64 - 1.0;
        (0..LOOK[1])
            .flat_map(|j| (0..LOOK[0]).map(move |i| (i, j)))
            .map(|(i, j)| {
                let direction = forward
                    + right * (self.half[0] * place(i, LOOK[0]))
                    + up * (self.half[1] * place(j, LOOK[1]));
                Ray::half_line(eye, direction.as_vec3(), 0.0)
            })
            .collect()
    }
}
