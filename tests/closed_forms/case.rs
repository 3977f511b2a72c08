//! A solved scene, and what its patches say in the file's units.

use certilux::embree::DeviceConfig;
use certilux::math::FacetId;
use certilux::occluder::OccluderConfig;
use certilux::scene::generate::generate;
use certilux::scene::{LoadConfig, Side, SidesMode, load_text};
use certilux::solve::{PreparedScene, Silent, SolveConfig, Solved, solve};
use glam::DVec3;
use std::f64::consts::PI;

pub struct Case {
    pub prepared: PreparedScene,
    pub solved: Solved,
}

/// A leaf patch on the front of a polygon. Area in square units of the file, the rest in W/m2.
pub struct Patch<'a> {
    pub material: &'a str,
    pub face: u32,
    pub corners: [DVec3; 3],
    pub area: f64,
    pub radiosity: f64,
    pub irradiance: f64,
}

impl Case {
    pub fn builtin(name: &str) -> Self {
        let text = generate(name).expect("a built-in scene");
        Self::from_text(&text.obj, &text.mtl, &format!("{name}.mtl"))
    }

    /// A built-in scene in which only the surfaces of `material` emit, a radiosity of 1 W/m2.
    pub fn builtin_lit_by(name: &str, material: &str) -> Self {
        let text = generate(name).expect("a built-in scene");
        let mut current = "";
        let mut mtl = String::new();
        for line in text.mtl.lines() {
            current = line.strip_prefix("newmtl ").unwrap_or(current).trim();
            if !line.trim_start().starts_with("Ke") {
                mtl += &format!("{line}\n");
            }
            if line.starts_with("newmtl ") && current == material {
                mtl += &format!("Ke {0} {0} {0}\n", 1.0 / PI);
            }
        }
        Self::from_text(&text.obj, &mtl, &format!("{name}.mtl"))
    }

    pub fn from_text(obj: &str, mtl: &str, library: &str) -> Self {
        let files = [(library, mtl.as_bytes())];
        let scene = load_text("case", obj.as_bytes(), &files, &LoadConfig::default())
            .expect("the scene loads");
        let config = SolveConfig::default();
        let prepared = PreparedScene::new(
            scene,
            SidesMode::Auto,
            config.seed,
            &DeviceConfig::default(),
        )
        .expect("Embree opens")
        .with_guarantees(config.technique, &OccluderConfig::default());
        let solved = solve(&prepared, &config, &Silent).expect("solves");
        Self { prepared, solved }
    }

    /// The patches of the fronts; never none.
    pub fn patches(&self) -> Vec<Patch<'_>> {
        let scene = &self.prepared.scene;
        let mut patches = Vec::new();
        for (f, facet) in self.solved.solution.facets.iter().enumerate() {
            if facet.side == Side::Back {
                continue;
            }
            for patch in self.solved.solution.facet_patches(FacetId::new(f)) {
                let [a, b, c] = patch.path.corners(scene.source_corners(facet.polygon));
                patches.push(Patch {
                    material: &scene.surface(facet.polygon).material,
                    face: scene.polygons[facet.polygon.index()].source_face,
                    corners: [a, b, c],
                    area: 0.5 * (b - a).cross(c - a).length(),
                    radiosity: f64::from(patch.radiosity[0]),
                    irradiance: f64::from(patch.irradiance[0]),
                });
            }
        }
        assert!(!patches.is_empty());
        patches
    }

    /// Area of the surfaces of `material`.
    pub fn area(&self, material: &str) -> f64 {
        self.sum(material, |_| 1.0)
    }

    /// Power that arrives at the surfaces of `material`.
    pub fn received(&self, material: &str) -> f64 {
        self.sum(material, |p| p.irradiance)
    }

    /// Mean radiosity of the surfaces of `material`.
    pub fn radiosity(&self, material: &str) -> f64 {
        self.sum(material, |p| p.radiosity) / self.area(material)
    }

    /// Form factor between materials, where `from` emits a radiosity of 1 W/m2 and nothing reflects.
    pub fn form_factor(&self, from: &str, to: &str) -> f64 {
        self.received(to) / self.area(from)
    }

    fn sum(&self, material: &str, value: impl Fn(&Patch) -> f64) -> f64 {
        let patches = self.patches();
        let of_material = patches.iter().filter(|p| p.material == material);
        let sum: f64 = of_material.clone().map(|p| p.area * value(p)).sum();
        assert!(of_material.count() > 0, "no surface of {material}");
        sum
    }
}

/// Prints the relative error of `got` and fails where it is above `tolerance`.
#[track_caller]
pub fn check(what: &str, got: f64, want: f64, tolerance: f64) {
    let error = got / want - 1.0;
    eprintln!(
        "{what:<44} {got:>12.6} want {want:>12.6} error {:>8.4} % of {} %",
        100.0 * error,
        100.0 * tolerance
    );
    assert!(error.abs() <= tolerance, "{what}: {got} is not {want}");
}
