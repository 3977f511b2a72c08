//! Which facets are neighbours, against the definition by brute force.

use crate::meshes::{Mesh, both_sides, fronts, grid};
use certilux::cluster::{ClusterConfig, Hierarchy, NodeKind, build_hierarchy, link_neighbours};
use certilux::scene::{Facet, Scene};
use glam::{DVec3, Vec3};
use proptest::prelude::*;
use std::collections::BTreeMap;

type Edge = [DVec3; 2];

fn edges(scene: &Scene, facet: Facet) -> [Edge; 3] {
    let corners = scene.facet_corners(facet).map(|v| v.as_dvec3());
    std::array::from_fn(|i| [corners[i], corners[(i + 1) % 3]])
}

/// Length over which two edges of lattice points lie on each other in opposite directions.
fn opposite_overlap(e: Edge, f: Edge) -> f64 {
    let along = (e[1] - e[0]).normalize();
    if (f[1] - f[0]).dot(along) >= 0.0 {
        return 0.0;
    }
    let off_line = |p: DVec3| (p - e[0]).cross(along).length() > 1.0e-9;
    if off_line(f[0]) || off_line(f[1]) {
        return 0.0;
    }
    let at = |p: DVec3| (p - e[0]).dot(along);
    (at(e[1]).min(at(f[0])) - at(f[1]).max(0.0)).max(0.0)
}

/// Shared border of each pair of neighbours, by the definition.
fn oracle(scene: &Scene, facets: &[Facet]) -> BTreeMap<(u32, u32), f64> {
    let matched = |facet: Facet, edge: Edge| {
        facets.iter().any(|&other| {
            other.polygon != facet.polygon && edges(scene, other).contains(&[edge[1], edge[0]])
        })
    };
    let mut shared = BTreeMap::new();
    for (i, &a) in facets.iter().enumerate() {
        for (j, &b) in facets.iter().enumerate().skip(i + 1) {
            if a.polygon == b.polygon {
                continue;
            }
            let mut length = 0.0;
            for e in edges(scene, a) {
                for f in edges(scene, b) {
                    let same_edge = e == [f[1], f[0]];
                    if same_edge || !(matched(a, e) && matched(b, f)) {
                        length += opposite_overlap(e, f);
                    }
                }
            }
            if length > 1.0e-9 {
                shared.insert((i as u32, j as u32), length);
            }
        }
    }
    shared
}

fn assert_links_are(scene: &Scene, facets: &[Facet]) -> Result<(), TestCaseError> {
    let links = link_neighbours(scene, facets, 1.0e-6);
    let expected = oracle(scene, facets);
    let found: Vec<_> = links.iter().map(|l| (l.a, l.b)).collect();
    let wanted: Vec<_> = expected.keys().copied().collect();
    prop_assert_eq!(found, wanted);
    for (link, length) in links.iter().zip(expected.values()) {
        prop_assert!((link.length - length).abs() < 1.0e-9);
    }
    Ok(())
}

/// Triangles with corners in general position, in a line, shared, doubled and turned over, on a
/// lattice that is long enough for edges to lie on parts of others.
fn lattice_mesh(count: usize) -> impl Strategy<Value = Mesh> {
    let triangle = [0_u32..20, 0_u32..20, 0_u32..20]
        .prop_filter("distinct corners", |[a, b, c]| a != b && b != c && a != c);
    let positions: Vec<_> = (0..20)
        .map(|i| Vec3::new((i % 5) as f32, (i / 5 % 2) as f32, (i / 10) as f32) * 0.25)
        .collect();
    prop::collection::vec(triangle, 1..count).prop_map(move |triangles| Mesh {
        positions: positions.clone(),
        triangles,
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn neighbours_are_those_of_the_definition(mesh in lattice_mesh(16), two_sided: bool) {
        let scene = mesh.scene();
        let facets = if two_sided { both_sides(&scene) } else { fronts(&scene) };
        assert_links_are(&scene, &facets)?;
    }

    /// Every triangle with vertices of its own, a little off: welding restores the same links.
    #[test]
    fn cracks_within_the_weld_distance_are_closed(mesh in lattice_mesh(16), seed: u64) {
        let whole = mesh.scene();
        let mut random = crate::meshes::Random::new(seed);
        let mut torn = Mesh::default();
        for triangle in &mesh.triangles {
            for &corner in triangle {
                let mut jitter = || (random.unit() - 0.5) * 2.0e-7;
                let off = Vec3::new(jitter(), jitter(), jitter());
                torn.positions.push(mesh.positions[corner as usize] + off);
            }
            let base = torn.positions.len() as u32 - 3;
            torn.triangles.push([base, base + 1, base + 2]);
        }
        let torn = torn.scene();
        let pairs = |scene: &Scene| -> Vec<_> {
            let links = link_neighbours(scene, &fronts(scene), 1.0e-6);
            links.iter().map(|l| (l.a, l.b)).collect()
        };
        prop_assert_eq!(pairs(&whole), pairs(&torn));
    }
}

#[test]
fn meshes_that_meet_in_t_junctions_are_one_piece() {
    for (left, right) in [(1, 7), (3, 5), (200, 1), (64, 48)] {
        let mut mesh = grid(Vec3::ZERO, Vec3::X * 0.5, Vec3::Y, 4, left);
        mesh.append(&grid(Vec3::X * 0.5, Vec3::X * 0.5, Vec3::Y, 4, right));
        let scene = mesh.scene();
        let facets = fronts(&scene);
        let hierarchy = build_hierarchy(&scene, &facets, &ClusterConfig::default());
        assert_eq!(hierarchy.validate(&scene), Ok(()));
        let root = hierarchy.node(Hierarchy::ROOT);
        assert_eq!(root.kind, NodeKind::FaceCluster, "{left} beside {right}");
        assert!(hierarchy.shape(Hierarchy::ROOT).deviation <= 1.0e-6);
    }
}

#[test]
fn an_edge_shared_by_thousands_makes_few_links() {
    let mut mesh = Mesh {
        positions: vec![Vec3::ZERO, Vec3::Z],
        triangles: Vec::new(),
    };
    for page in 0..3_000_u32 {
        let angle = page as f32 * 0.002;
        mesh.positions
            .push(Vec3::new(angle.cos(), angle.sin(), 0.5));
        let [from, to] = if page % 2 == 0 { [0, 1] } else { [1, 0] };
        mesh.triangles.push([from, to, page + 2]);
    }
    let scene = mesh.scene();
    for facets in [fronts(&scene), both_sides(&scene)] {
        let links = link_neighbours(&scene, &facets, 1.0e-6);
        assert!(links.len() >= facets.len() / 2);
        assert!(links.len() <= 4 * facets.len(), "{}", links.len());
        // The flat continuation of a page, half a turn further, is among its neighbours.
        let opposite = 1_570.8_f32 as u32;
        let partner = facets
            .iter()
            .position(|f| f.polygon.0 == opposite | 1)
            .unwrap() as u32;
        assert!(links.iter().any(|l| l.a == 0 && l.b.abs_diff(partner) <= 4));
    }
}

#[test]
fn many_edges_on_one_line_end_soon() {
    let mut mesh = Mesh::default();
    for plank in 0..4_000_u32 {
        let shift = plank as f32 / 8_000.0;
        let side = if plank % 2 == 0 { 1.0 } else { -1.0 };
        mesh.positions.extend([
            Vec3::X * shift,
            Vec3::X * (shift + 0.5),
            Vec3::new(shift, side * 0.25, 0.0),
        ]);
        let base = 3 * plank;
        mesh.triangles.push(if plank % 2 == 0 {
            [base, base + 1, base + 2]
        } else {
            [base + 1, base, base + 2]
        });
    }
    let scene = mesh.scene();
    let links = link_neighbours(&scene, &fronts(&scene), 1.0e-6);
    assert!(!links.is_empty());
    assert!(links.len() <= 20 * scene.polygons.len());
}
