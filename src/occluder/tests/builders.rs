//! Scenes and hierarchies made by hand, walls meshed in many ways.

use crate::cluster::{ClusterShape, Hierarchy, Node, NodeKind};
use crate::math::{Aabb, Cone, NodeId, Plane, PolygonId, hash_u64};
use crate::occluder::{OccluderConfig, OccluderSet, extract_occluders};
use crate::scene::{Facet, Normalisation, Polygon, Scene, Side, Surface};
use glam::{DMat3, DVec2, DVec3, Vec3};

/// A triangle in f64, before rounding.
pub type Triangle = [DVec3; 3];

/// w of the test scenes: their box is the unit cube.
pub const WELD: f64 = 1.0e-6 * 1.732_050_8;

/// A small deterministic generator.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// Uniform in [0, 1).
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(1);
        (hash_u64(self.0) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Uniform in [low, high).
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Uniform below `n`.
    pub fn below(&mut self, n: usize) -> usize {
        ((self.unit() * n as f64) as usize).min(n - 1)
    }

    /// A rotation with a random axis and angle.
    pub fn rotation(&mut self) -> DMat3 {
        let axis = DVec3::new(
            self.between(-1.0, 1.0),
            self.between(-1.0, 1.0),
            self.between(-1.0, 1.0),
        );
        DMat3::from_axis_angle(axis.normalize_or(DVec3::Z), self.between(0.0, 6.0))
    }
}

/// A scene of `triangles` whose box is the unit cube (two far triangles outside the hierarchy see to
/// that), indexed where corners round to the same f32 position.
pub fn scene_of(triangles: &[Triangle]) -> Scene {
    let mut positions: Vec<Vec3> = Vec::new();
    let mut known = std::collections::HashMap::new();
    let mut vertex = |p: Vec3| {
        *known
            .entry(p.to_array().map(f32::to_bits))
            .or_insert_with(|| {
                positions.push(p);
                positions.len() as u32 - 1
            })
    };
    let far = [1.0f32, -1.0].map(|s| {
        [
            Vec3::splat(0.5 * s),
            Vec3::new(0.5, 0.49, 0.5) * s,
            Vec3::new(0.49, 0.5, 0.5) * s,
        ]
    });
    let polygons: Vec<Polygon> = triangles
        .iter()
        .map(|t| t.map(|p| p.as_vec3()))
        .chain(far)
        .enumerate()
        .map(|(i, t)| Polygon {
            vertices: t.map(&mut vertex),
            source_face: i as u32,
            surface: 0,
        })
        .collect();
    Scene {
        name: "test".into(),
        source_positions: positions.iter().map(|p| p.as_dvec3()).collect(),
        source_faces: polygons.len() as u32,
        positions,
        polygons,
        surfaces: vec![Surface {
            material: "grey".into(),
            reflectance: [0.5; 3],
            emission: [1.0; 3],
        }],
        normalisation: Normalisation {
            centre: DVec3::ZERO,
            scale: 1.0,
            turn: glam::DMat3::IDENTITY,
        },
        dropped_faces: Vec::new(),
        contacts: crate::scene::Contacts::default(),
        warnings: Vec::new(),
    }
}

/// The front facets of the first `count` polygons.
pub fn fronts(count: usize) -> Vec<Facet> {
    (0..count)
        .map(|i| Facet {
            polygon: PolygonId::new(i),
            side: Side::Front,
        })
        .collect()
}

/// A hierarchy whose root is a face cluster of `facets`, halved in their order down to leaves.
pub fn hierarchy_of(scene: &Scene, facets: Vec<Facet>) -> Hierarchy {
    let mut hierarchy = Hierarchy {
        nodes: Vec::new(),
        shapes: Vec::new(),
        leaf_of_facet: vec![NodeId(0); facets.len()],
        facets,
    };
    let all = 0..hierarchy.facets.len();
    push_node(&mut hierarchy, scene, all);
    let mut next = 0;
    while next < hierarchy.nodes.len() {
        let range = hierarchy.facet_range(NodeId::new(next));
        if range.len() > 1 {
            let middle = usize::midpoint(range.start, range.end);
            hierarchy.nodes[next].first_child = hierarchy.nodes.len() as u32;
            push_node(&mut hierarchy, scene, range.start..middle);
            push_node(&mut hierarchy, scene, middle..range.end);
        }
        next += 1;
    }
    hierarchy
}

fn push_node(hierarchy: &mut Hierarchy, scene: &Scene, range: std::ops::Range<usize>) {
    let corners: Vec<[Vec3; 3]> = hierarchy.facets[range.clone()]
        .iter()
        .map(|&f| scene.facet_corners(f))
        .collect();
    let (mut area, mut vector, mut moment) = (0.0, Vec3::ZERO, Vec3::ZERO);
    let mut cone: Option<Cone> = None;
    for [a, b, c] in &corners {
        let normal = 0.5 * (*b - *a).cross(*c - *a);
        area += normal.length();
        vector += normal;
        moment += normal.length() * (*a + *b + *c) / 3.0;
        let own = Cone::from_direction(normal.normalize_or(Vec3::Z));
        cone = Some(cone.map_or(own, |cone| cone.union(own)));
    }
    let plane = Plane::through(moment / area, vector.normalize_or(Vec3::Z));
    let points = corners.iter().flatten().copied();
    hierarchy.shapes.push(ClusterShape {
        area,
        centroid: moment / area,
        area_vector: vector,
        cone: cone.unwrap_or(Cone::EVERYTHING),
        plane,
        deviation: points
            .clone()
            .fold(0.0, |d: f32, p| d.max(plane.distance(p).abs()))
            .next_up(),
    });
    hierarchy.nodes.push(Node {
        bounds: Aabb::from_points(points),
        first_child: 0,
        first_facet: range.start as u32,
        facet_count: range.len() as u32,
        kind: if range.len() == 1 {
            NodeKind::Facet
        } else {
            NodeKind::FaceCluster
        },
    });
}

/// The occluders of `triangles`, taken as one face cluster, and their scene.
pub fn extract(triangles: &[Triangle]) -> (Scene, OccluderSet) {
    extract_with(triangles, &OccluderConfig::default())
}

/// The same with a configuration.
pub fn extract_with(triangles: &[Triangle], config: &OccluderConfig) -> (Scene, OccluderSet) {
    let scene = scene_of(triangles);
    let hierarchy = hierarchy_of(&scene, fronts(triangles.len()));
    let set = extract_occluders(&scene, &hierarchy, config);
    (scene, set)
}

/// An upright rectangular wall with rectangular holes, in its own plane.
#[derive(Clone, Debug)]
pub struct Wall {
    pub size: DVec2,
    pub holes: Vec<[DVec2; 2]>,
}

impl Wall {
    /// A wall with a door and two windows.
    pub fn with_door_and_windows() -> Self {
        let p = DVec2::new;
        Self {
            size: p(0.6, 0.3),
            holes: vec![
                [p(0.10, 0.0), p(0.19, 0.21)],
                [p(0.28, 0.1), p(0.37, 0.21)],
                [p(0.45, 0.1), p(0.54, 0.21)],
            ],
        }
    }

    /// True area.
    pub fn area(&self) -> f64 {
        let cells = self.cells();
        cells.iter().map(|[a, b]| (*b - *a).element_product()).sum()
    }

    fn is_hole(&self, p: DVec2) -> bool {
        self.holes
            .iter()
            .any(|[a, b]| a.cmplt(p).all() && p.cmplt(*b).all())
    }

    /// The coarsest grid that the holes allow: cells that are wholly wall.
    fn cells(&self) -> Vec<[DVec2; 2]> {
        let lines = |axis: usize| {
            let mut at = vec![0.0, self.size[axis]];
            at.extend(self.holes.iter().flat_map(|[a, b]| [a[axis], b[axis]]));
            at.sort_by(f64::total_cmp);
            at.dedup();
            at
        };
        let (xs, ys) = (lines(0), lines(1));
        let mut cells = Vec::new();
        for y in ys.windows(2) {
            for x in xs.windows(2) {
                let (low, high) = (DVec2::new(x[0], y[0]), DVec2::new(x[1], y[1]));
                if !self.is_hole(0.5 * (low + high)) {
                    cells.push([low, high]);
                }
            }
        }
        cells
    }

    /// Meshed by cutting cells at random places until there are `count` triangles: T-junctions
    /// everywhere.
    pub fn cut_at_random(&self, count: usize, seed: u64) -> Vec<[DVec2; 3]> {
        let mut random = Random::new(seed);
        let mut cells = self.cells();
        while 2 * cells.len() < count {
            // The largest of a few, so that sizes stay within reason.
            let pick = (0..4)
                .map(|_| random.below(cells.len()))
                .max_by(|&a, &b| {
                    let area = |i: usize| (cells[i][1] - cells[i][0]).element_product();
                    area(a).total_cmp(&area(b))
                })
                .unwrap();
            let [low, high] = cells.swap_remove(pick);
            let t = random.between(0.2, 0.8);
            if (high - low).x > (high - low).y {
                let x = low.x + t * (high.x - low.x);
                cells.push([low, DVec2::new(x, high.y)]);
                cells.push([DVec2::new(x, low.y), high]);
            } else {
                let y = low.y + t * (high.y - low.y);
                cells.push([low, DVec2::new(high.x, y)]);
                cells.push([DVec2::new(low.x, y), high]);
            }
        }
        cells
            .iter()
            .flat_map(|&[low, high]| split(low, high, random.unit() < 0.5))
            .collect()
    }

    /// Meshed as a regular grid of about `count` triangles in each cell; neighbouring cells do not
    /// match, so T-junctions stand along their common sides.
    pub fn regular(&self, count: usize) -> Vec<[DVec2; 3]> {
        let edge = (2.0 * self.area() / count as f64).sqrt();
        self.cells()
            .iter()
            .flat_map(|&[low, high]| {
                let n = ((high - low) / edge).round().max(DVec2::ONE);
                let at = move |i: f64, j: f64| low + (high - low) * DVec2::new(i, j) / n;
                (0..n.y as usize).flat_map(move |j| {
                    (0..n.x as usize).flat_map(move |i| {
                        let (i, j) = (i as f64, j as f64);
                        split(at(i, j), at(i + 1.0, j + 1.0), true)
                    })
                })
            })
            .collect()
    }
}

fn split(low: DVec2, high: DVec2, rising: bool) -> [[DVec2; 3]; 2] {
    let (right, left) = (DVec2::new(high.x, low.y), DVec2::new(low.x, high.y));
    if rising {
        [[low, right, high], [low, high, left]]
    } else {
        [[low, right, left], [right, high, left]]
    }
}

/// Where a plane mesh stands in space: its point p goes to `origin + axes * (p, 0)`.
#[derive(Clone, Copy)]
pub struct Placement {
    pub origin: DVec3,
    pub axes: DMat3,
}

impl Placement {
    /// Upright in the middle of the scene, off its centre.
    pub fn plain() -> Self {
        Self {
            origin: DVec3::new(-0.25, -0.25, 0.125),
            axes: DMat3::IDENTITY,
        }
    }

    /// Turned at random about the scene's centre.
    pub fn turned(seed: u64) -> Self {
        let axes = Random::new(seed).rotation();
        Self {
            origin: axes * DVec3::new(-0.3, -0.15, 0.05),
            axes,
        }
    }

    pub fn place(&self, triangles: &[[DVec2; 3]]) -> Vec<Triangle> {
        triangles
            .iter()
            .map(|t| t.map(|p| self.origin + self.axes * p.extend(0.0)))
            .collect()
    }

    /// The plane coordinates and the height of a point of space.
    pub fn back(&self, p: DVec3) -> DVec3 {
        self.axes.transpose() * (p - self.origin)
    }
}

/// A height field over the rectangle (0,0)-(size) as an n x m grid of triangle pairs.
pub fn height_field(
    size: DVec2,
    n: usize,
    m: usize,
    height: impl Fn(DVec2) -> f64,
) -> Vec<Triangle> {
    let at = |i: usize, j: usize| {
        let p = size * DVec2::new(i as f64 / n as f64, j as f64 / m as f64);
        p.extend(height(p))
    };
    (0..m)
        .flat_map(|j| (0..n).map(move |i| (i, j)))
        .flat_map(|(i, j)| {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            [[a, b, c], [a, c, d]]
        })
        .collect()
}
