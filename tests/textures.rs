//! Textures from file to surface: a polygon has the mean colour of the texels that it shows.

use certilux::scene::{LoadConfig, LoadError, Reason, Scene, load_text};
use std::io::Cursor;

/// Left half black, right half at `value` of 255, as a PNG.
fn halves(value: u8) -> Vec<u8> {
    let mut png = Vec::new();
    image::RgbImage::from_fn(64, 64, |x, _| {
        image::Rgb([if x < 32 { 0 } else { value }; 3])
    })
    .write_to(&mut Cursor::new(&mut png), image::ImageFormat::Png)
    .unwrap();
    png
}

/// Two triangles over the left and the right half of the texture, and one without coordinates.
const OBJ: &str = "mtllib m.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n\
    vt 0 0\nvt .5 0\nvt .5 1\nvt 1 0\nf 1/1 2/2 3/3\nf 1/2 2/4 4/3\nf 2 3 4\n";

fn load(mtl: &str, image: &[u8], config: &LoadConfig) -> Result<Scene, LoadError> {
    let files: [(&str, &[u8]); 2] = [("m.mtl", mtl.as_bytes()), ("halves.png", image)];
    load_text("t.obj", OBJ.as_bytes(), &files, config)
}

/// Of each polygon, red.
fn red(scene: &Scene, of: impl Fn(&certilux::scene::Surface) -> [f64; 3]) -> Vec<f64> {
    scene
        .polygons
        .iter()
        .map(|p| of(&scene.surfaces[p.surface as usize])[0])
        .collect()
}

#[track_caller]
fn assert_near(found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len());
    for (f, e) in found.iter().zip(expected) {
        assert!((f - e).abs() < 1e-5, "{found:?} against {expected:?}");
    }
}

/// 128 of 255 in sRGB (IEC 61966-2-1): ((128/255 + 0.055) / 1.055)^2.4.
const HALF: f64 = 0.215_860_5;

#[test]
fn reflectance_is_the_texture_times_kd() {
    let mtl = "newmtl a\nKd .5 .5 .5\nKe 1 1 1\nmap_Kd halves.png\n";
    let scene = load(mtl, &halves(128), &LoadConfig::default()).unwrap();
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    assert_near(
        &red(&scene, |s| s.reflectance),
        &[0.0, 0.5 * HALF, 0.25 * HALF],
    );
    assert_near(&red(&scene, |s| s.emission), &[1.0; 3]);
    assert_eq!(scene.surfaces.len(), 3);
}

#[test]
fn a_black_or_absent_factor_leaves_the_texture_as_it_is() {
    for factor in ["", "Kd 0 0 0\n", "Kd 1 1 1\n"] {
        let mtl = format!("newmtl a\n{factor}Ke 1 1 1\nmap_Kd C:\\maps\\halves.png\n");
        let scene = load(&mtl, &halves(128), &LoadConfig::default()).unwrap();
        assert_near(&red(&scene, |s| s.reflectance), &[0.0, HALF, 0.5 * HALF]);
    }
}

#[test]
fn emission_and_options() {
    // Moved by half the image, the halves change places.
    let mtl = "newmtl a\nKd .1 .1 .1\nKe 8 8 8\nmap_Ke -o 0.5 0 0 halves.png\n";
    let scene = load(mtl, &halves(128), &LoadConfig::default()).unwrap();
    assert_near(&red(&scene, |s| s.emission), &[8.0 * HALF, 0.0, 4.0 * HALF]);
}

#[test]
fn a_white_texture_reflects_too_much() {
    let mtl = "newmtl a\nKe 1 1 1\nmap_Kd halves.png\n";
    let error = load(mtl, &halves(255), &LoadConfig::default()).unwrap_err();
    assert_eq!(error.defects.len(), 1);
    assert_eq!(
        error.defects[0].reason,
        Reason::ReflectanceTooHigh {
            material: "a".into(),
            value: [1.0; 3],
            texture: Some("halves.png".into())
        }
    );
    let mut config = LoadConfig::default();
    config.clamp_reflectance = true;
    let scene = load(mtl, &halves(255), &config).unwrap();
    assert_near(&red(&scene, |s| s.reflectance), &[0.0, 0.999, 0.5]);
}

#[test]
fn an_unreadable_image_leaves_the_plain_colour() {
    for (name, what) in [
        ("halves.png", "could not be read"),
        ("other.png", "no such file"),
    ] {
        let mtl = format!("newmtl a\nKd .4 .4 .4\nKe 1 1 1\nmap_Kd {name}\n");
        let scene = load(&mtl, b"\x89PNG but not really", &LoadConfig::default()).unwrap();
        assert_near(&red(&scene, |s| s.reflectance), &[0.4; 3]);
        assert_eq!(scene.warnings.len(), 1);
        assert!(scene.warnings[0].0.contains(what), "{:?}", scene.warnings);
    }
}
