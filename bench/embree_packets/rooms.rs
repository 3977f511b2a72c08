//! A grid of furnished rooms with doors, as large as asked, normalised to the unit cube.

use crate::numbers::Numbers;
use glam::Vec3;

/// A triangle soup with shared vertices inside each quad only.
pub struct Rooms {
    pub positions: Vec<Vec3>,
    pub triangles: Vec<[u32; 3]>,
    /// Triangles of each room, for exchanges that stay inside one.
    pub by_room: Vec<Vec<u32>>,
}

/// Metres: rooms of 4 x 4 x 3, as flats have.
const SIDE: f32 = 4.0;
const HEIGHT: f32 = 3.0;
/// Pieces of furniture a room; with the walls some 520 triangles a room.
const BOXES: usize = 30;
/// Walls are cut into this many cells each way, so that a door is a missing cell or two.
const CELLS: usize = 4;

impl Rooms {
    /// `n` x `n` rooms.
    pub fn new(n: usize) -> Self {
        let mut rooms = Self {
            positions: Vec::new(),
            triangles: Vec::new(),
            by_room: Vec::new(),
        };
        let mut numbers = Numbers::new(n as u64);
        for row in 0..n {
            for column in 0..n {
                let start = rooms.triangles.len() as u32;
                let corner = Vec3::new(column as f32 * SIDE, row as f32 * SIDE, 0.0);
                rooms.shell(corner, column + 1 == n, row + 1 == n);
                for _ in 0..BOXES {
                    rooms.furniture(corner, &mut numbers);
                }
                rooms
                    .by_room
                    .push((start..rooms.triangles.len() as u32).collect());
            }
        }
        let scale = 1.0 / (n as f32 * SIDE);
        for p in &mut rooms.positions {
            *p = *p * scale - Vec3::new(0.5, 0.5, 0.0);
        }
        rooms
    }

    /// Floor, ceiling and the walls at the low x and y sides; the outer ones at the high sides.
    fn shell(&mut self, corner: Vec3, last_column: bool, last_row: bool) {
        let (x, y, z) = (Vec3::X * SIDE, Vec3::Y * SIDE, Vec3::Z * HEIGHT);
        self.sheet(corner, x, y, false);
        self.sheet(corner + z, y, x, false);
        self.sheet(corner, y, z, corner.x > 0.0);
        self.sheet(corner, z, x, corner.y > 0.0);
        if last_column {
            self.sheet(corner + x, z, y, false);
        }
        if last_row {
            self.sheet(corner + y, x, z, false);
        }
    }

    /// A parallelogram cut into cells; with a door, two cells at its foot are left out.
    fn sheet(&mut self, corner: Vec3, u: Vec3, v: Vec3, door: bool) {
        let (du, dv) = (u / CELLS as f32, v / CELLS as f32);
        for i in 0..CELLS {
            for j in 0..CELLS {
                // The cell's place along the wall and its height, whichever of u and v is up.
                let (along, up) = if v.z > 0.0 { (i, j) } else { (j, i) };
                if door && along == 1 && up < 2 {
                    continue;
                }
                self.quad(corner + du * i as f32 + dv * j as f32, du, dv);
            }
        }
    }

    fn furniture(&mut self, room: Vec3, numbers: &mut Numbers) {
        let size = Vec3::new(
            0.1 + 0.5 * numbers.next(),
            0.1 + 0.5 * numbers.next(),
            0.1 + 0.9 * numbers.next(),
        );
        let room_left = Vec3::new(SIDE, SIDE, HEIGHT) - size;
        let place = Vec3::new(numbers.next(), numbers.next(), numbers.next().powi(2));
        let corner = room + room_left * place;
        let (x, y, z) = (Vec3::X * size.x, Vec3::Y * size.y, Vec3::Z * size.z);
        for (corner, u, v) in [
            (corner, y, x),
            (corner + z, x, y),
            (corner, x, z),
            (corner + y, z, x),
            (corner, z, y),
            (corner + x, y, z),
        ] {
            self.quad(corner, u, v);
        }
    }

    fn quad(&mut self, corner: Vec3, u: Vec3, v: Vec3) {
        let base = self.positions.len() as u32;
        self.positions
            .extend([corner, corner + u, corner + u + v, corner + v]);
        self.triangles
            .extend([[base, base + 1, base + 2], [base, base + 2, base + 3]]);
    }

    /// A random point of a triangle.
    pub fn point(&self, triangle: u32, numbers: &mut Numbers) -> Vec3 {
        let [a, b, c] = self.triangles[triangle as usize].map(|v| self.positions[v as usize]);
        let (mut u, mut v) = (numbers.next(), numbers.next());
        if u + v > 1.0 {
            (u, v) = (1.0 - u, 1.0 - v);
        }
        a + (b - a) * u + (c - a) * v
    }
}
