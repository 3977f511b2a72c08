//! A reader for just what the generators write, so that the tests judge the text itself.

use glam::DVec3;
use std::collections::BTreeMap;

/// A material of the MTL text.
#[derive(Clone, Debug, Default)]
pub struct ReadMaterial {
    pub kd: [f64; 3],
    pub ke: [f64; 3],
}

/// One `f` statement.
#[derive(Clone, Debug)]
pub struct ReadTriangle {
    pub corners: [DVec3; 3],
    pub material: String,
    /// Number of `o` statements before it.
    pub object: usize,
}

impl ReadTriangle {
    /// Twice the area times the unit normal.
    pub fn cross(&self) -> DVec3 {
        let [a, b, c] = self.corners;
        (b - a).cross(c - a)
    }

    pub fn centroid(&self) -> DVec3 {
        let [a, b, c] = self.corners;
        (a + b + c) / 3.0
    }

    pub fn area(&self) -> f64 {
        self.cross().length() * 0.5
    }
}

/// A scene read back from its text.
#[derive(Clone, Debug)]
pub struct ReadScene {
    pub triangles: Vec<ReadTriangle>,
    pub materials: BTreeMap<String, ReadMaterial>,
    pub library: String,
    pub object_names: Vec<String>,
}

/// Reads what [`certilux::scene::generate::generate`] gives for `name`; panics on anything odd.
pub fn read(name: &str) -> ReadScene {
    let scene = certilux::scene::generate::generate(name).expect("a built-in scene");
    let mut vertices = Vec::new();
    let mut read = ReadScene {
        triangles: Vec::new(),
        materials: read_materials(&scene.mtl),
        library: String::new(),
        object_names: Vec::new(),
    };
    let mut material = None;
    for line in scene.obj.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => vertices.push(DVec3::from(numbers(words))),
            Some("mtllib") => read.library = words.next().expect("a file").to_owned(),
            Some("usemtl") => material = words.next().map(str::to_owned),
            Some("o") => read
                .object_names
                .push(words.next().expect("a name").to_owned()),
            Some("f") => {
                let indices = words
                    .map(|w| w.parse::<usize>().expect("an index") - 1)
                    .collect::<Vec<_>>();
                let indices: [usize; 3] = indices.try_into().expect("three corners");
                read.triangles.push(ReadTriangle {
                    corners: indices.map(|i| vertices[i]),
                    material: material.clone().expect("usemtl before f"),
                    object: read.object_names.len(),
                });
            }
            Some("#") | None => {}
            Some(other) => panic!("{name}: unexpected statement {other}"),
        }
    }
    read
}

fn read_materials(text: &str) -> BTreeMap<String, ReadMaterial> {
    let mut materials = BTreeMap::new();
    let mut current = String::new();
    for line in text.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("newmtl") => {
                current = words.next().expect("a name").to_owned();
                let fresh = materials.insert(current.clone(), ReadMaterial::default());
                assert!(fresh.is_none(), "material {current} defined twice");
            }
            Some("Kd") => materials.get_mut(&current).expect("newmtl").kd = numbers(words),
            Some("Ke") => materials.get_mut(&current).expect("newmtl").ke = numbers(words),
            _ => {}
        }
    }
    materials
}

fn numbers<'a>(words: impl Iterator<Item = &'a str>) -> [f64; 3] {
    let all: Vec<f64> = words.map(|w| w.parse().expect("a number")).collect();
    all.try_into().expect("three numbers")
}
