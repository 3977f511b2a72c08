//! A pinhole camera in the file's units.

use glam::{DVec2, DVec3};

/// Widest picture side in pixels: the largest that common viewers open.
const LARGEST_SIDE: u32 = 16_384;

/// Largest coordinate: beyond it squares leave the range of f64.
const FARTHEST: f64 = 1.0e150;

/// Sine of the angle between the view and `up` below which "up" says nothing.
const LEAST_UP: f64 = 1.0e-6;

/// A pinhole camera as it was asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Where the picture is taken from.
    pub eye: DVec3,
    /// What stands in the middle of the picture.
    pub target: DVec3,
    /// What points upwards in the picture; neither its length nor its slant matters.
    pub up: DVec3,
    /// Vertical angle of view in degrees, in (0, 180).
    pub fov: f64,
    /// Width and height in pixels.
    pub size: [u32; 2],
}

/// Why a camera takes no picture.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CameraError {
    /// A coordinate or angle is NaN or infinite.
    #[error("the camera's {0} is not finite")]
    NotFinite(&'static str),
    /// A coordinate whose square is beyond any number.
    #[error(
        "the camera's {0} has a coordinate beyond 1e150, farther than distances can be computed"
    )]
    TooFar(&'static str),
    /// Nowhere to look.
    #[error("the camera's eye and target are the same point")]
    NoDirection,
    /// The picture would have no upper edge.
    #[error("the camera's up direction is zero or points along the view")]
    NoUp,
    /// Outside what a pinhole can see.
    #[error("the camera's angle of view is {0} degrees; it must lie between 0 and 180")]
    AngleOfView(f64),
    /// No pixel, or too many.
    #[error("a picture of {0} x {1} pixels; each side must be 1 to {LARGEST_SIDE}")]
    Size(u32, u32),
}

/// A checked camera: directions of rays through the pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PinHole {
    eye: DVec3,
    forward: DVec3,
    right: DVec3,
    down: DVec3,
    size: [u32; 2],
}

impl Camera {
    /// Checks the camera.
    ///
    /// # Errors
    /// [`CameraError`], the first defect found.
    pub fn pin_hole(&self) -> Result<PinHole, CameraError> {
        for (name, v) in [("eye", self.eye), ("target", self.target), ("up", self.up)] {
            if !v.is_finite() {
                return Err(CameraError::NotFinite(name));
            }
            if v.abs().max_element() > FARTHEST {
                return Err(CameraError::TooFar(name));
            }
        }
        if !(self.fov > 0.0 && self.fov < 180.0) {
            return Err(CameraError::AngleOfView(self.fov));
        }
        let [width, height] = self.size;
        if !(1..=LARGEST_SIDE).contains(&width) || !(1..=LARGEST_SIDE).contains(&height) {
            return Err(CameraError::Size(width, height));
        }
        let forward = (self.target - self.eye)
            .try_normalize()
            .ok_or(CameraError::NoDirection)?;
        let up = self.up.try_normalize().ok_or(CameraError::NoUp)?;
        let right = forward.cross(up);
        if right.length() < LEAST_UP {
            return Err(CameraError::NoUp);
        }
        let right = right.normalize();
        // Half the picture's height at distance 1, spread over half the pixels.
        let pixel = (0.5 * self.fov.to_radians()).tan() / (0.5 * f64::from(height));
        Ok(PinHole {
            eye: self.eye,
            forward,
            right: right * pixel,
            down: forward.cross(right) * pixel,
            size: self.size,
        })
    }
}

impl PinHole {
    /// Where all rays start.
    pub fn eye(&self) -> DVec3 {
        self.eye
    }

    /// Unit direction of the view.
    pub fn forward(&self) -> DVec3 {
        self.forward
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// The direction through a point of the picture, in pixels from its upper left corner. Its
    /// component along [`Self::forward`] is 1, so a ray's `t` is the depth.
    pub fn direction(&self, pixel: DVec2) -> DVec3 {
        let [width, height] = self.size.map(f64::from);
        self.forward + self.right * (pixel.x - 0.5 * width) + self.down * (pixel.y - 0.5 * height)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CAMERA: Camera = Camera {
        eye: DVec3::new(1.0, 2.0, 3.0),
        target: DVec3::new(1.0, 2.0, -7.0),
        up: DVec3::new(0.0, 5.0, 1.0),
        fov: 90.0,
        size: [400, 200],
    };

    #[test]
    fn the_picture_is_upright_and_not_mirrored() {
        let pin_hole = CAMERA.pin_hole().unwrap();
        let near = |pixel: [f64; 2], expected: [f64; 3]| {
            let d = pin_hole.direction(DVec2::from_array(pixel));
            assert!((d - DVec3::from_array(expected)).length() < 1e-12, "{d}");
        };
        near([200.0, 100.0], [0.0, 0.0, -1.0]);
        // 90 degrees of height: the upper edge's middle is as high as it is far.
        near([200.0, 0.0], [0.0, 1.0, -1.0]);
        near([400.0, 100.0], [2.0, 0.0, -1.0]);
    }

    #[test]
    fn senseless_cameras_are_refused() {
        let with = |change: fn(&mut Camera)| {
            let mut camera = CAMERA;
            change(&mut camera);
            camera.pin_hole().unwrap_err()
        };
        assert_eq!(with(|c| c.eye.x = f64::NAN), CameraError::NotFinite("eye"));
        assert_eq!(with(|c| c.target = c.eye), CameraError::NoDirection);
        assert_eq!(with(|c| c.up = DVec3::Z), CameraError::NoUp);
        assert_eq!(with(|c| c.up = DVec3::ZERO), CameraError::NoUp);
        assert_eq!(with(|c| c.fov = 180.0), CameraError::AngleOfView(180.0));
        assert!(matches!(
            with(|c| c.fov = f64::NAN),
            CameraError::AngleOfView(_)
        ));
        assert_eq!(with(|c| c.size = [0, 9]), CameraError::Size(0, 9));
        assert_eq!(with(|c| c.size[1] = 20_000), CameraError::Size(400, 20_000));
    }
}
