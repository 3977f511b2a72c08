//! A measured scene, and the z-test.

use certilux::embree::DeviceConfig;
use certilux::reference::{
    FaceRadiosity, Reference, ReferenceConfig, SilentReference, TracedScene, measure,
};
use certilux::scene::generate::generate;
use certilux::scene::{LoadConfig, SidesMode, load_text};
use std::collections::BTreeMap;

/// Greatest |z| of a sum over faces: a right reference fails any of the forty such tests of this suite with a
/// probability of 1 % (two-sided, Bonferroni: 2.5e-4 each).
pub const GREATEST_Z: f64 = 3.66;

pub struct Measured {
    pub traced: TracedScene,
    pub reference: Reference,
    material_of_face: BTreeMap<u32, String>,
}

impl Measured {
    pub fn builtin(name: &str, error: f64) -> Self {
        Self::with_materials(name, &[], error)
    }

    /// A built-in scene whose `materials` are replaced: name, reflectance, emitted radiosity in W/m2.
    pub fn with_materials(name: &str, materials: &[(&str, f64, f64)], error: f64) -> Self {
        let text = generate(name).expect("a built-in scene");
        let mut mtl = String::new();
        let mut replaced = None;
        for line in text.mtl.lines() {
            if let Some(material) = line.strip_prefix("newmtl ") {
                replaced = materials.iter().find(|m| m.0 == material.trim());
                mtl += &format!("{line}\n");
                if let Some((_, kd, b)) = replaced {
                    let ke = b / std::f64::consts::PI;
                    mtl += &format!("Kd {kd} {kd} {kd}\nKe {ke} {ke} {ke}\n");
                }
            } else if replaced.is_none() || !line.trim_start().starts_with('K') {
                mtl += &format!("{line}\n");
            }
        }
        let library = format!("{name}.mtl");
        Self::from_text(&text.obj, &library, &mtl, error)
    }

    pub fn from_text(obj: &str, library: &str, mtl: &str, error: f64) -> Self {
        let traced = traced(obj, library, mtl, SidesMode::Auto);
        let mut config = ReferenceConfig::default();
        config.error = error;
        let reference = measure(&traced, &config, &SilentReference).expect("measures");
        assert!(reference.reached && !reference.faces.is_empty());
        let scene = &traced.scene;
        let material_of_face = scene
            .polygons
            .iter()
            .map(|p| {
                let surface = &scene.surfaces[p.surface as usize];
                (p.source_face, surface.material.clone())
            })
            .collect();
        Self {
            traced,
            reference,
            material_of_face,
        }
    }

    /// The faces of a material; never none.
    pub fn faces(&self, material: &str) -> Vec<&FaceRadiosity> {
        let found: Vec<_> = self
            .reference
            .faces
            .iter()
            .filter(|f| self.material_of_face[&f.face].starts_with(material))
            .collect();
        assert!(!found.is_empty(), "no face of {material}");
        found
    }

    /// Area-weighted mean radiosity of a material and its standard error; grey scenes only.
    pub fn mean(&self, material: &str) -> (f64, f64) {
        let (mut area, mut sum, mut squares) = (0.0, 0.0, 0.0);
        for face in self.faces(material) {
            area += face.area;
            sum += face.area * face.radiosity[0];
            squares += (face.area * face.standard_error[0]).powi(2);
        }
        (sum / area, squares.sqrt() / area)
    }
}

pub fn traced(obj: &str, library: &str, mtl: &str, sides: SidesMode) -> TracedScene {
    let files = [(library, mtl.as_bytes())];
    let scene =
        load_text("case", obj.as_bytes(), &files, &LoadConfig::default()).expect("the scene loads");
    TracedScene::new(scene, sides, 1, &DeviceConfig::default()).expect("Embree opens")
}

/// Prints and checks the z-score of a measured value. `sharp` is the greatest standard error, relative to `want`, with
/// which the test says anything.
#[track_caller]
pub fn z_test(what: &str, (got, stderr): (f64, f64), want: f64, sharp: f64) {
    let z = (got - want) / stderr;
    eprintln!(
        "{what:<44} {got:>12.6} +- {:.3} % want {want:>12.6} z {z:>6.2}",
        100.0 * stderr / want
    );
    assert!(stderr > 0.0 && stderr <= sharp * want, "{what}: {stderr}");
    assert!(
        z.abs() <= GREATEST_Z,
        "{what}: {got} +- {stderr} is not {want}"
    );
}
