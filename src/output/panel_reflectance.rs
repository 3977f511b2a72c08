//! The reflectance of a panel, which a mesh does not carry.

use super::SolvedMesh;
use super::panel::{Panel, Panels};

/// How much radiosity a panel adds per irradiance, a channel: its reflectance, read off its patches
/// because a mesh carries no materials. Zero where nothing tells.
pub(crate) fn reflectance(mesh: &SolvedMesh, panels: &Panels, panel: &Panel) -> [f32; 3] {
    /// Irradiance must differ by this share within a panel for its slope to be more than rounding.
    const TELLING: f64 = 1.0e-2;
    let faces = &mesh.faces[panels.leaf_range(panel)];
    std::array::from_fn(|c| {
        let pair = |f: &super::SolvedFace| (f64::from(f.irradiance[c]), f64::from(f.radiosity[c]));
        let (mut least, mut greatest) = (pair(&faces[0]), pair(&faces[0]));
        for face in faces {
            let (e, b) = pair(face);
            if e < least.0 {
                least = (e, b);
            }
            if e > greatest.0 {
                greatest = (e, b);
            }
        }
        let slope = if greatest.0 - least.0 > TELLING * greatest.0 {
            (greatest.1 - least.1) / (greatest.0 - least.0)
        } else if greatest.1 <= greatest.0 && greatest.0 > 0.0 {
            greatest.1 / greatest.0
        } else {
            0.0
        };
        slope.clamp(0.0, 1.0) as f32
    })
}

#[cfg(test)]
mod tests {
    use super::super::fixture::floor_and_wall;
    use super::*;

    #[test]
    fn the_reflectance_is_read_off_the_patches() {
        let mut mesh = floor_and_wall();
        let panels = Panels::new(&mesh);
        let of = |mesh: &SolvedMesh, p: usize| reflectance(mesh, &panels, &panels.panels[p])[0];
        assert!((of(&mesh, 0) - 0.5).abs() < 1e-5);
        // An emitter of varied irradiance: the slope, not the ratio.
        for face in &mut mesh.faces {
            face.radiosity = face.irradiance.map(|e| 30.0 + 0.75 * e);
        }
        assert!((of(&mesh, 0) - 0.75).abs() < 1e-4);
        // An emitter under uniform light tells nothing.
        for face in &mut mesh.faces {
            face.irradiance = [1.0; 3];
            face.radiosity = [30.75; 3];
        }
        assert_eq!(of(&mesh, 0), 0.0);
    }
}
