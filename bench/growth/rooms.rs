//! A square array of furnished rooms joined by doors, as OBJ text.

use std::fmt::Write;

/// The materials.
pub const MTL: &str = "newmtl wall\nKd 0.7 0.7 0.7\nnewmtl wood\nKd 0.4 0.4 0.4\nnewmtl lamp\nKd 0 0 0\nKe 10 10 10\n";

/// Side of a room and its height, in metres.
const SIDE: f64 = 5.0;
const HEIGHT: f64 = 3.0;
/// Where a door begins along its wall, its width and height.
const DOOR: [f64; 3] = [2.0, 1.0, 2.1];
/// Triangles of a room inside a large array.
const TRIANGLES: f64 = 62.0;

/// Rooms along each side of the array that has about so many polygons.
pub fn rooms_along(polygons: usize) -> usize {
    (((polygons as f64) / TRIANGLES).sqrt().round() as usize).max(1)
}

/// The array of `along` x `along` rooms.
pub fn obj(along: usize) -> String {
    let mut mesh = Mesh::default();
    let far = along as f64 * SIDE;
    for i in 0..along {
        for j in 0..along {
            mesh.room(i as f64 * SIDE, j as f64 * SIDE, (i + 3 * j) % 4);
            let (x, z) = (i as f64 * SIDE, j as f64 * SIDE);
            if i + 1 < along {
                mesh.wall_with_door([x + SIDE, z], [0.0, 1.0]);
            }
            if j + 1 < along {
                mesh.wall_with_door([x, z + SIDE], [1.0, 0.0]);
            }
        }
        let at = i as f64 * SIDE;
        mesh.upright([at, 0.0], [at + SIDE, 0.0], [0.0, HEIGHT]);
        mesh.upright([at, far], [at + SIDE, far], [0.0, HEIGHT]);
        mesh.upright([0.0, at], [0.0, at + SIDE], [0.0, HEIGHT]);
        mesh.upright([far, at], [far, at + SIDE], [0.0, HEIGHT]);
    }
    mesh.obj
}

struct Mesh {
    obj: String,
    vertices: usize,
    material: &'static str,
}

impl Default for Mesh {
    fn default() -> Self {
        Self {
            obj: "mtllib m.mtl\n".to_owned(),
            vertices: 0,
            material: "",
        }
    }
}

impl Mesh {
    fn quad(&mut self, material: &'static str, corners: [[f64; 3]; 4]) {
        let obj = &mut self.obj;
        if self.material != material {
            self.material = material;
            let _ = writeln!(obj, "usemtl {material}");
        }
        for [x, y, z] in corners {
            let _ = writeln!(obj, "v {x} {y} {z}");
        }
        let first = self.vertices + 1;
        let _ = writeln!(obj, "f {first} {} {} {}", first + 1, first + 2, first + 3);
        self.vertices += 4;
    }

    /// A rectangle that stands between two points of the floor, and shows its front to neither room in particular:
    /// sides are found by probes.
    fn upright(&mut self, [x0, z0]: [f64; 2], [x1, z1]: [f64; 2], [low, high]: [f64; 2]) {
        self.quad(
            "wall",
            [[x0, low, z0], [x1, low, z1], [x1, high, z1], [x0, high, z0]],
        );
    }

    fn wall_with_door(&mut self, [x, z]: [f64; 2], [dx, dz]: [f64; 2]) {
        let at = |s: f64| [x + dx * s, z + dz * s];
        let [from, width, height] = DOOR;
        self.upright(at(0.0), at(from), [0.0, HEIGHT]);
        self.upright(at(from), at(from + width), [height, HEIGHT]);
        self.upright(at(from + width), at(SIDE), [0.0, HEIGHT]);
    }

    /// Floor and ceiling in four, a lamp, three crates that stand apart from the walls.
    fn room(&mut self, x: f64, z: f64, variant: usize) {
        let half = 0.5 * SIDE;
        for (a, b) in [(0.0, 0.0), (half, 0.0), (0.0, half), (half, half)] {
            let (x0, z0) = (x + a, z + b);
            let (x1, z1) = (x0 + half, z0 + half);
            self.quad(
                "wall",
                [[x0, 0.0, z0], [x0, 0.0, z1], [x1, 0.0, z1], [x1, 0.0, z0]],
            );
            let y = HEIGHT;
            self.quad("wall", [[x0, y, z0], [x1, y, z0], [x1, y, z1], [x0, y, z1]]);
        }
        let (y, lamp) = (HEIGHT - 0.1, 0.4);
        let (cx, cz) = (x + half, z + half);
        self.quad(
            "lamp",
            [
                [cx - lamp, y, cz - lamp],
                [cx + lamp, y, cz - lamp],
                [cx + lamp, y, cz + lamp],
                [cx - lamp, y, cz + lamp],
            ],
        );
        let shift = 0.15 * variant as f64;
        self.crate_at([x + 0.5 + shift, z + 0.4], [1.2, 0.75, 0.7]);
        self.crate_at([x + 3.6, z + 0.6 + shift], [0.8, 1.8, 0.6]);
        self.crate_at([x + 3.4 - shift, z + 3.7], [1.0, 0.45, 0.8]);
    }

    /// Four sides and a top.
    fn crate_at(&mut self, [x, z]: [f64; 2], [w, h, d]: [f64; 3]) {
        let ring = [[x, z], [x + w, z], [x + w, z + d], [x, z + d]];
        for k in 0..4 {
            let ([ax, az], [bx, bz]) = (ring[k], ring[(k + 1) % 4]);
            self.quad(
                "wood",
                [[bx, 0.0, bz], [ax, 0.0, az], [ax, h, az], [bx, h, bz]],
            );
        }
        self.quad(
            "wood",
            [[x, h, z], [x, h, z + d], [x + w, h, z + d], [x + w, h, z]],
        );
    }
}
