//! Small scenes as lists of corners, and as OBJ text with every digit.

use glam::DVec3;
use std::fmt::Write;

/// The materials that scenes name.
pub const MTL: &str =
    "newmtl wall\nKd 0.5 0.5 0.5\nnewmtl red\nKd 0.6 0.2 0.1\nnewmtl lamp\nKd 0 0 0\nKe 10 10 10\n";

/// Faces with their materials.
#[derive(Clone, Default)]
pub struct Mesh {
    faces: Vec<(&'static str, Vec<DVec3>)>,
}

/// Which way the sides of a box look.
#[derive(Clone, Copy)]
pub enum Facing {
    Inwards,
    Outwards,
}

impl Mesh {
    /// A room of side 2 around the origin, with a lamp of 0.5 x 0.5 a little under its ceiling (y = 1).
    pub fn room() -> Self {
        Self::default()
            .cuboid("wall", DVec3::NEG_ONE, DVec3::ONE, Facing::Inwards)
            .lamp(DVec3::new(0.0, 0.875, 0.0), 0.25)
    }

    /// A square that looks down, from whose centre its sides are `half` away.
    pub fn lamp(self, centre: DVec3, half: f64) -> Self {
        let at = |x: f64, z: f64| centre + half * DVec3::new(x, 0.0, z);
        self.face(
            "lamp",
            &[at(-1., -1.), at(1., -1.), at(1., 1.), at(-1., 1.)],
        )
    }

    /// One more face, counter-clockwise from its front.
    pub fn face(mut self, material: &'static str, corners: &[DVec3]) -> Self {
        self.faces.push((material, corners.to_vec()));
        self
    }

    /// All faces of another mesh.
    pub fn with(mut self, other: Self) -> Self {
        self.faces.extend(other.faces);
        self
    }

    /// The parallelogram at `corner` along `u` and `v`, in `columns` x `rows` quadrilaterals that look along u x v.
    pub fn sheet(
        mut self,
        material: &'static str,
        [corner, u, v]: [DVec3; 3],
        [columns, rows]: [usize; 2],
    ) -> Self {
        let at = |i: usize, j: usize| {
            corner + u * (i as f64 / columns as f64) + v * (j as f64 / rows as f64)
        };
        for j in 0..rows {
            for i in 0..columns {
                let corners = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                self.faces.push((material, corners.to_vec()));
            }
        }
        self
    }

    /// An axis-aligned box.
    pub fn cuboid(
        mut self,
        material: &'static str,
        min: DVec3,
        max: DVec3,
        facing: Facing,
    ) -> Self {
        for axis in 0..3 {
            let mut u = DVec3::ZERO;
            let mut v = DVec3::ZERO;
            u[(axis + 1) % 3] = max[(axis + 1) % 3] - min[(axis + 1) % 3];
            v[(axis + 2) % 3] = max[(axis + 2) % 3] - min[(axis + 2) % 3];
            let mut far = min;
            far[axis] = max[axis];
            let (low, high) = match facing {
                Facing::Inwards => ([min, u, v], [far, v, u]),
                Facing::Outwards => ([min, v, u], [far, u, v]),
            };
            self = self
                .sheet(material, low, [1, 1])
                .sheet(material, high, [1, 1]);
        }
        self
    }

    /// Every corner through `map`.
    pub fn mapped(mut self, map: impl Fn(DVec3) -> DVec3) -> Self {
        for (_, corners) in &mut self.faces {
            for corner in corners {
                *corner = map(*corner);
            }
        }
        self
    }

    /// The OBJ file; equal corners are one vertex.
    pub fn obj(&self) -> String {
        let mut text = String::from("mtllib m.mtl\n");
        let mut index = std::collections::HashMap::new();
        let mut faces = String::new();
        let mut material = "";
        for (own, corners) in &self.faces {
            if *own != material {
                material = own;
                writeln!(faces, "usemtl {own}").unwrap();
            }
            faces.push('f');
            for corner in corners {
                let next = index.len() + 1;
                let number = *index
                    .entry(corner.to_array().map(f64::to_bits))
                    .or_insert_with(|| {
                        writeln!(text, "v {:?} {:?} {:?}", corner.x, corner.y, corner.z).unwrap();
                        next
                    });
                write!(faces, " {number}").unwrap();
            }
            faces.push('\n');
        }
        text + &faces
    }
}

/// Faces of the dark half and of the lit half in [`two_rooms`].
pub const DARK_ROOM: std::ops::Range<u32> = 0..5;
pub const LIT_ROOM: std::ops::Range<u32> = 5..10;

/// The room of side 2 in two halves, meshed apart, that meet in the plane z = 0; the lamp is in the half above it.
pub fn two_rooms() -> Mesh {
    let half = |z0: f64, z1: f64, end: f64| {
        let at = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
        let (x, y, z) = (at(2.0, 0.0, 0.0), at(0.0, 2.0, 0.0), at(0.0, 0.0, z1 - z0));
        let wall = if end < 0.0 {
            [at(-1.0, -1.0, end), x, y]
        } else {
            [at(-1.0, -1.0, end), y, x]
        };
        Mesh::default()
            .sheet("wall", [at(-1.0, -1.0, z0), z, x], [1, 1])
            .sheet("wall", [at(-1.0, 1.0, z0), x, z], [1, 1])
            .sheet("wall", [at(-1.0, -1.0, z0), y, z], [1, 1])
            .sheet("wall", [at(1.0, -1.0, z0), z, y], [1, 1])
            .sheet("wall", wall, [1, 1])
    };
    half(-1.0, 0.0, -1.0)
        .with(half(0.0, 1.0, 1.0))
        .lamp(DVec3::new(0.0, 0.875, 0.5), 0.2)
}
