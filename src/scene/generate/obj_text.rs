//! A mesh as OBJ and MTL text, the same bytes every time.
//!
//! Meshes are built with z up; OBJ files are read with y up by most programs, so `(x, y, z)` is
//! written as `(x, z, -y)`, a rotation that keeps the winding.

use super::material::Material;
use super::mesh::Mesh;
use std::fmt::Write;

/// Decimals of a coordinate: a micrometre, below the weld distance of any scene over a metre.
const DECIMALS: usize = 6;

/// The OBJ text of a mesh, naming `material_library` as its MTL file.
pub fn obj_text(mesh: &Mesh, material_library: &str) -> String {
    let mut text = String::new();
    let mut line = |arguments: std::fmt::Arguments| {
        // Writing to a String cannot fail.
        let _ = text.write_fmt(arguments);
        text.push('\n');
    };
    line(format_args!("# certilux built-in scene: metres, y up"));
    line(format_args!("mtllib {material_library}"));
    for v in &mesh.vertices {
        line(format_args!(
            "v {} {} {}",
            decimal(v.x),
            decimal(v.z),
            decimal(-v.y)
        ));
    }
    let mut objects = mesh.objects.iter().enumerate().peekable();
    let mut material = None;
    for (index, triangle) in mesh.triangles.iter().enumerate() {
        while let Some((number, object)) = objects.next_if(|(_, o)| o.first <= index) {
            line(format_args!("o {}_{}", object.name, number + 1));
        }
        if material != Some(triangle.material) {
            material = Some(triangle.material);
            let name = mesh.materials[triangle.material.0].name;
            line(format_args!("usemtl {name}"));
        }
        let [a, b, c] = triangle.vertices.map(|v| v + 1);
        line(format_args!("f {a} {b} {c}"));
    }
    text
}

/// The MTL text of a scene's materials.
pub fn mtl_text(materials: &[Material]) -> String {
    let mut text = String::from("# certilux built-in scene: Kd reflectance, Ke W/m2/sr\n");
    for Material { name, kd, ke } in materials {
        let _ = write!(
            text,
            "\nnewmtl {name}\nKd {} {} {}\nKe {} {} {}\n",
            kd[0], kd[1], kd[2], ke[0], ke[1], ke[2]
        );
    }
    text
}

/// A coordinate with at most [`DECIMALS`] decimals, without trailing zeros or a negative zero.
fn decimal(value: f64) -> String {
    let text = format!("{value:.DECIMALS$}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0" } else { text }.to_owned()
}

#[cfg(test)]
mod tests {
    use super::decimal;

    #[test]
    fn coordinates_are_short_and_have_no_negative_zero() {
        assert_eq!(decimal(0.1 + 0.2), "0.3");
        assert_eq!(decimal(-1e-9), "0");
        assert_eq!(decimal(-2.5), "-2.5");
        assert_eq!(decimal(100.0), "100");
    }
}
