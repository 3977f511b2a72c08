//! Meshes that the clustering tests share.

use certilux::math::PolygonId;
use certilux::scene::{Facet, Normalisation, Polygon, Scene, Side, Surface};
use glam::{DVec3, Quat, Vec3};

/// A triangle mesh in the making.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    pub positions: Vec<Vec3>,
    pub triangles: Vec<[u32; 3]>,
}

impl Mesh {
    pub fn append(&mut self, other: &Self) {
        let base = self.positions.len() as u32;
        self.positions.extend(&other.positions);
        self.triangles
            .extend(other.triangles.iter().map(|t| t.map(|v| v + base)));
    }

    pub fn map(mut self, f: impl Fn(Vec3) -> Vec3) -> Self {
        for position in &mut self.positions {
            *position = f(*position);
        }
        self
    }

    pub fn rotate(self, rotation: Quat) -> Self {
        self.map(|p| rotation * p)
    }

    pub fn scene(&self) -> Scene {
        Scene {
            name: "test".into(),
            positions: self.positions.clone(),
            source_positions: self.positions.iter().map(|p| p.as_dvec3()).collect(),
            polygons: self
                .triangles
                .iter()
                .enumerate()
                .map(|(face, &vertices)| Polygon {
                    vertices,
                    source_face: face as u32,
                    surface: 0,
                })
                .collect(),
            surfaces: vec![Surface {
                material: "white".into(),
                reflectance: [0.5; 3],
                emission: [1.0; 3],
            }],
            normalisation: Normalisation {
                centre: DVec3::ZERO,
                scale: 1.0,
                turn: glam::DMat3::IDENTITY,
            },
            source_faces: self.triangles.len() as u32,
            dropped_faces: Vec::new(),
            contacts: certilux::scene::Contacts::default(),
            warnings: Vec::new(),
        }
    }
}

/// The front facets of a scene.
pub fn fronts(scene: &Scene) -> Vec<Facet> {
    (0..scene.polygons.len())
        .map(|p| Facet {
            polygon: PolygonId::new(p),
            side: Side::Front,
        })
        .collect()
}

/// Both facets of every polygon.
pub fn both_sides(scene: &Scene) -> Vec<Facet> {
    fronts(scene)
        .into_iter()
        .flat_map(|front| {
            let back = Facet {
                side: Side::Back,
                ..front
            };
            [front, back]
        })
        .collect()
}

/// A small generator of pseudo-random numbers in [0, 1) (xorshift64*), so that meshes need no crate.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    pub fn unit(&mut self) -> f32 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 40) as f32 / 16_777_216.0
    }

    pub fn below(&mut self, bound: usize) -> usize {
        ((self.unit() * bound as f32) as usize).min(bound - 1)
    }
}

/// The rectangle from `origin` along `u` and `v` in `columns` times `rows` cells of two triangles,
/// its front towards `u` cross `v`.
pub fn grid(origin: Vec3, u: Vec3, v: Vec3, columns: u32, rows: u32) -> Mesh {
    let mut mesh = Mesh::default();
    for row in 0..=rows {
        for column in 0..=columns {
            mesh.positions.push(
                origin + u * (column as f32 / columns as f32) + v * (row as f32 / rows as f32),
            );
        }
    }
    let at = |column, row| row * (columns + 1) + column;
    for row in 0..rows {
        for column in 0..columns {
            let (a, b) = (at(column, row), at(column + 1, row));
            let (d, c) = (at(column, row + 1), at(column + 1, row + 1));
            mesh.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    mesh
}

/// A rectangle cut into `count` triangles by splitting random edges at random points, the
/// neighbours along: irregular, without T-junctions.
pub fn random_wall(origin: Vec3, u: Vec3, v: Vec3, count: usize, seed: u64) -> Mesh {
    let mut random = Random::new(seed);
    // In the unit square, each triangle with its neighbours found through a map of edges.
    let mut points = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0_f32]];
    let mut triangles: Vec<[u32; 3]> = vec![[0, 1, 2], [0, 2, 3]];
    let mut owner = std::collections::HashMap::new();
    for (index, t) in triangles.iter().enumerate() {
        for i in 0..3 {
            owner.insert((t[i], t[(i + 1) % 3]), index);
        }
    }
    while triangles.len() < count {
        let index = random.below(triangles.len());
        let t = triangles[index];
        let length = |i: usize| {
            let (p, q) = (points[t[i] as usize], points[t[(i + 1) % 3] as usize]);
            (p[0] - q[0]).hypot(p[1] - q[1])
        };
        let side = (0..3)
            .max_by(|&i, &j| length(i).total_cmp(&length(j)))
            .unwrap();
        let (from, to) = (t[side], t[(side + 1) % 3]);
        let share = 0.3 + 0.4 * random.unit();
        let middle = points.len() as u32;
        let (p, q) = (points[from as usize], points[to as usize]);
        points.push([p[0] + share * (q[0] - p[0]), p[1] + share * (q[1] - p[1])]);
        for (a, b) in [(from, to), (to, from)] {
            let Some(index) = owner.remove(&(a, b)) else {
                continue;
            };
            let t = triangles[index];
            let i = (0..3).find(|&i| t[i] == a).unwrap();
            let apex = t[(i + 2) % 3];
            let added = triangles.len();
            triangles[index] = [a, middle, apex];
            triangles.push([middle, b, apex]);
            owner.insert((a, middle), index);
            owner.insert((middle, apex), index);
            owner.insert((middle, b), added);
            owner.insert((b, apex), added);
            owner.insert((apex, middle), added);
        }
    }
    Mesh {
        positions: points
            .iter()
            .map(|p| origin + u * p[0] + v * p[1])
            .collect(),
        triangles,
    }
}

/// The 12 triangles of a box, fronts outwards.
pub fn cuboid(low: Vec3, high: Vec3) -> Mesh {
    let positions = (0..8)
        .map(|i| {
            Vec3::select(
                glam::BVec3::new(i & 1 == 1, i & 2 == 2, i & 4 == 4),
                high,
                low,
            )
        })
        .collect();
    let quads = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    Mesh {
        positions,
        triangles: quads
            .iter()
            .flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]])
            .collect(),
    }
}

/// A sphere of latitude and longitude, fronts outwards.
pub fn sphere(centre: Vec3, radius: f32, segments: u32) -> Mesh {
    let rings = segments / 2;
    let mut mesh = Mesh::default();
    let point = |ring: u32, segment: u32| {
        let polar = std::f32::consts::PI * ring as f32 / rings as f32;
        let azimuth = std::f32::consts::TAU * segment as f32 / segments as f32;
        centre
            + radius
                * Vec3::new(
                    polar.sin() * azimuth.cos(),
                    polar.sin() * azimuth.sin(),
                    polar.cos(),
                )
    };
    mesh.positions.push(point(0, 0));
    for ring in 1..rings {
        mesh.positions.extend((0..segments).map(|s| point(ring, s)));
    }
    mesh.positions.push(point(rings, 0));
    let at = |ring: u32, segment: u32| 1 + (ring - 1) * segments + segment % segments;
    let last = mesh.positions.len() as u32 - 1;
    for s in 0..segments {
        mesh.triangles.push([0, at(1, s), at(1, s + 1)]);
        for ring in 1..rings - 1 {
            let (a, b) = (at(ring, s), at(ring + 1, s));
            let (d, c) = (at(ring, s + 1), at(ring + 1, s + 1));
            mesh.triangles.extend([[a, b, c], [a, c, d]]);
        }
        mesh.triangles
            .push([at(rings - 1, s), last, at(rings - 1, s + 1)]);
    }
    mesh
}
