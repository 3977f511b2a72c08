//! The named materials of the built-in scenes.

/// A diffuse material as it goes into the MTL file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Name in the MTL file; one name always means the same values within a scene.
    pub name: &'static str,
    /// Diffuse reflectance of red, green and blue, each in [0, 1).
    pub kd: [f64; 3],
    /// Emitted radiance in W/m2/sr.
    pub ke: [f64; 3],
}

impl Material {
    /// A material that reflects and does not emit.
    pub const fn matte(name: &'static str, kd: [f64; 3]) -> Self {
        Self {
            name,
            kd,
            ke: [0.0; 3],
        }
    }

    /// A grey material with the same reflectance and emitted radiance in every channel.
    pub const fn grey(name: &'static str, reflectance: f64, radiance: f64) -> Self {
        Self {
            name,
            kd: [reflectance; 3],
            ke: [radiance; 3],
        }
    }

    /// A lamp's surface: bright paint that emits `ke`.
    pub const fn lamp(name: &'static str, ke: [f64; 3]) -> Self {
        Self {
            name,
            kd: [0.7, 0.7, 0.68],
            ke,
        }
    }
}
