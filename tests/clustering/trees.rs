//! The trees that clustering grows on surfaces whose clusters are known.

use crate::meshes::{self, Mesh, Random, both_sides, cuboid, fronts, grid, random_wall, sphere};
use certilux::cluster::{ClusterConfig, Hierarchy, NodeKind, build_hierarchy};
use certilux::math::NodeId;
use certilux::scene::{Facet, Scene};
use glam::{Quat, Vec3};
use proptest::prelude::*;

fn build(scene: &Scene, facets: &[Facet]) -> Hierarchy {
    let hierarchy = build_hierarchy(scene, facets, &ClusterConfig::default());
    assert_eq!(hierarchy.validate(scene), Ok(()));
    hierarchy
}

fn nodes(hierarchy: &Hierarchy) -> impl Iterator<Item = NodeId> {
    (0..hierarchy.nodes.len()).map(NodeId::new)
}

fn depth(hierarchy: &Hierarchy) -> usize {
    let mut depth = vec![0; hierarchy.nodes.len()];
    for id in nodes(hierarchy) {
        for child in hierarchy.children(id).into_iter().flatten() {
            depth[child.index()] = depth[id.index()] + 1;
        }
    }
    depth.into_iter().max().unwrap_or(0)
}

/// The node that covers exactly the polygons of `wanted`.
fn node_of(hierarchy: &Hierarchy, wanted: std::ops::Range<usize>) -> Option<NodeId> {
    nodes(hierarchy).find(|&id| {
        let facets = &hierarchy.facets[hierarchy.facet_range(id)];
        facets.len() == wanted.len() && facets.iter().all(|f| wanted.contains(&f.polygon.index()))
    })
}

#[test]
fn a_cube_has_six_flat_pairs() {
    let scene = cuboid(Vec3::splat(-0.4), Vec3::splat(0.4)).scene();
    let hierarchy = build(&scene, &fronts(&scene));
    for face in 0..6 {
        let id = node_of(&hierarchy, 2 * face..2 * face + 2).expect("each face is a node");
        assert_eq!(hierarchy.node(id).kind, NodeKind::FaceCluster);
        assert!(hierarchy.shape(id).deviation < 1.0e-7);
        assert!((hierarchy.shape(id).area - 0.64).abs() < 1.0e-6);
    }
}

/// A room corner: a wall, meshed as given, with a finely meshed floor and side wall attached.
fn corner_with(wall: &Mesh) -> (Mesh, std::ops::Range<usize>) {
    let mut mesh = wall.clone();
    let count = wall.triangles.len();
    mesh.append(&grid(Vec3::ZERO, Vec3::Y, Vec3::X, 16, 16));
    mesh.append(&grid(Vec3::ZERO, Vec3::Z, Vec3::Y, 16, 16));
    // A small box against the wall, its rim shared with nothing.
    mesh.append(&cuboid(
        Vec3::new(0.4, 0.0, 0.4),
        Vec3::new(0.42, 0.02, 0.42),
    ));
    (mesh, 0..count)
}

#[test]
fn a_wall_is_one_flat_node_however_it_is_meshed() {
    let tilt = Quat::from_euler(glam::EulerRot::XYZ, 0.3, 0.7, 1.1);
    for rotation in [Quat::IDENTITY, tilt] {
        for cells in [1, 10, 100] {
            for regular in [true, false] {
                let wall = if regular {
                    grid(Vec3::ZERO, Vec3::X, Vec3::Z, cells, cells)
                } else {
                    random_wall(
                        Vec3::ZERO,
                        Vec3::X,
                        Vec3::Z,
                        2 * (cells * cells) as usize,
                        7,
                    )
                };
                let (mesh, wall) = corner_with(&wall);
                let scene = mesh.rotate(rotation).map(|p| p * 0.5).scene();
                let hierarchy = build(&scene, &fronts(&scene));
                let id = node_of(&hierarchy, wall.clone())
                    .unwrap_or_else(|| panic!("no node for {} triangles", wall.len()));
                let shape = hierarchy.shape(id);
                assert_eq!(hierarchy.node(id).kind, NodeKind::FaceCluster);
                assert!(shape.deviation <= 1.0e-6, "deviation {}", shape.deviation);
                assert!((shape.area - 0.25).abs() < 1.0e-5);
                if rotation == Quat::IDENTITY {
                    assert!(shape.cone.half_angle < 1.0e-6);
                }
            }
        }
    }
}

#[test]
fn narrow_clusters_tile_a_sphere() {
    let scene = sphere(Vec3::ZERO, 0.5, 64).scene();
    let hierarchy = build(&scene, &fronts(&scene));
    let limit = 20.0_f32.to_radians();
    let mut covered = 0;
    let mut clusters = Vec::new();
    let mut open = vec![Hierarchy::ROOT];
    while let Some(id) = open.pop() {
        if hierarchy.shape(id).cone.half_angle <= limit {
            covered += hierarchy.node(id).facet_count as usize;
            clusters.push(id);
        } else {
            open.extend(hierarchy.children(id).expect("a facet is narrow"));
        }
    }
    assert_eq!(covered, scene.polygons.len());
    // A cap of half-angle 20 degrees is 3.0 % of the sphere; caps that tile cannot do with fewer
    // than 33, and clusters half as wide as they may be would be over 130.
    assert!((33..=130).contains(&clusters.len()), "{}", clusters.len());
}

#[test]
fn the_same_input_gives_the_same_tree() {
    let scene = sphere(Vec3::ZERO, 0.5, 48).scene();
    let facets = both_sides(&scene);
    let first = build(&scene, &facets);
    for threads in [1, 3] {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        let again = pool.install(|| build(&scene, &facets));
        assert_eq!(format!("{first:?}"), format!("{again:?}"));
    }
}

/// Children and facets, which is the tree without its numbers.
fn topology(hierarchy: &Hierarchy) -> Vec<(u32, u32, u32)> {
    let shape = |n: &certilux::cluster::Node| (n.first_child, n.first_facet, n.facet_count);
    let facets = hierarchy
        .facets
        .iter()
        .map(|f| (f.polygon.0, f.side as u32, 0));
    hierarchy.nodes.iter().map(shape).chain(facets).collect()
}

#[test]
fn scaling_by_a_power_of_two_gives_the_same_tree() {
    let mut mesh = sphere(Vec3::splat(0.1), 0.3, 32);
    mesh.append(&random_wall(Vec3::splat(-0.5), Vec3::X, Vec3::Z, 500, 3));
    let scene = mesh.scene();
    let tree = topology(&build(&scene, &fronts(&scene)));
    for exponent in [-12, -1, 1, 9] {
        let scaled = mesh.clone().map(|p| p * 2.0_f32.powi(exponent)).scene();
        assert_eq!(tree, topology(&build(&scaled, &fronts(&scaled))));
    }
}

/// The facet sets that are nodes, each as a sorted list of polygons.
fn node_sets(hierarchy: &Hierarchy) -> std::collections::BTreeSet<Vec<u32>> {
    let set = |id| {
        let facets = &hierarchy.facets[hierarchy.facet_range(id)];
        let mut polygons: Vec<u32> = facets.iter().map(|f| f.polygon.0).collect();
        polygons.sort_unstable();
        polygons
    };
    nodes(hierarchy).map(set).collect()
}

#[test]
fn rounding_hardly_changes_the_tree() {
    let mut mesh = grid(Vec3::splat(-0.5), Vec3::X, Vec3::Y, 16, 16);
    mesh.append(&sphere(Vec3::splat(0.1), 0.3, 32));
    mesh.append(&cuboid(Vec3::splat(-0.4), Vec3::new(-0.1, -0.2, -0.3)));
    let scene = mesh.scene();
    let sets = node_sets(&build(&scene, &fronts(&scene)));
    let tilt = Quat::from_euler(glam::EulerRot::XYZ, 0.3, 0.7, 1.1);
    for moved in [
        mesh.clone().map(|p| p * 3.0),
        mesh.clone().map(|p| p * 0.1 + Vec3::new(0.3, -0.2, 0.1)),
        mesh.clone().rotate(tilt),
    ] {
        let moved = moved.scene();
        let again = node_sets(&build(&moved, &fronts(&moved)));
        let kept = sets.intersection(&again).count() as f64 / sets.len() as f64;
        assert!(kept >= 0.99, "only {kept} of the nodes are kept");
    }
}

#[test]
fn volumes_take_over_beyond_the_widest_cluster() {
    let scene = cuboid(Vec3::splat(-0.4), Vec3::splat(0.4)).scene();
    let mut config = ClusterConfig::default();
    config.widest = 0.5;
    let hierarchy = build_hierarchy(&scene, &fronts(&scene), &config);
    assert_eq!(hierarchy.validate(&scene), Ok(()));
    let count = |kind| hierarchy.nodes.iter().filter(|n| n.kind == kind).count();
    assert_eq!(count(NodeKind::FaceCluster), 6);
    assert_eq!(count(NodeKind::Volume), 5);
}

/// A wall with a small raised square in its middle, joined to it all around by steep facets.
#[test]
fn a_bump_stays_out_of_its_wall() {
    let cells = 40;
    for rise in [0.01, 0.0005, 0.00005] {
        let mut mesh = grid(Vec3::ZERO, Vec3::X, Vec3::Y, cells, cells);
        let raised = |p: Vec3| {
            let near = |x: f32| (0.49..0.56).contains(&x);
            near(p.x) && near(p.y)
        };
        for position in &mut mesh.positions {
            if raised(*position) {
                position.z += rise;
            }
        }
        let scene = mesh.scene();
        let hierarchy = build(&scene, &fronts(&scene));
        let flat: Vec<_> = (0..scene.polygons.len())
            .filter(|&p| {
                scene
                    .corners(certilux::math::PolygonId::new(p))
                    .iter()
                    .all(|v| v.z == 0.0)
            })
            .collect();
        let wall = nodes(&hierarchy)
            .find(|&id| {
                hierarchy.facet_range(id).len() == flat.len()
                    && hierarchy.shape(id).deviation <= 1.0e-6
            })
            .unwrap_or_else(|| panic!("the wall around a rise of {rise} is no node"));
        assert!(
            hierarchy.facets[hierarchy.facet_range(wall)]
                .iter()
                .all(|f| flat.contains(&f.polygon.index()))
        );
    }
}

/// Slivers have normals of noise; they must not keep the wall that they belong to from being one.
#[test]
fn slivers_do_not_split_a_wall() {
    let tilt = Quat::from_euler(glam::EulerRot::XYZ, 0.3, 0.7, 1.1);
    for thickness in [1.0e-4, 1.0e-5, 1.0e-6] {
        let mut mesh = grid(Vec3::ZERO, Vec3::X * 0.5, Vec3::Y, 8, 8);
        mesh.append(&grid(Vec3::X * 0.5, Vec3::X * thickness, Vec3::Y, 1, 8));
        let far = 0.5 + thickness;
        mesh.append(&grid(Vec3::X * far, Vec3::X * (1.0 - far), Vec3::Y, 8, 8));
        let count = mesh.triangles.len();
        mesh.append(&grid(Vec3::ZERO, Vec3::Y, Vec3::Z, 8, 8));
        let scene = mesh.rotate(tilt).map(|p| p * 0.5).scene();
        let hierarchy = build(&scene, &fronts(&scene));
        let wall = node_of(&hierarchy, 0..count)
            .unwrap_or_else(|| panic!("slivers of {thickness} split the wall"));
        assert!(hierarchy.shape(wall).deviation <= 1.0e-6);
    }
}

#[test]
fn one_facet_is_its_own_root() {
    let scene = Mesh {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
        triangles: vec![[0, 1, 2]],
    }
    .scene();
    let hierarchy = build(&scene, &fronts(&scene));
    assert_eq!(hierarchy.nodes.len(), 1);
    assert_eq!(hierarchy.nodes[0].kind, NodeKind::Facet);
    // Its two sides are back to back, not neighbours.
    let hierarchy = build(&scene, &both_sides(&scene));
    assert_eq!(hierarchy.nodes[0].kind, NodeKind::Volume);
    assert!(build(&scene, &[]).nodes.is_empty());
}

#[test]
fn the_sides_of_a_sheet_keep_apart() {
    let scene = grid(Vec3::ZERO, Vec3::X, Vec3::Y, 8, 8).scene();
    let hierarchy = build(&scene, &both_sides(&scene));
    let [front, back] = hierarchy.children(Hierarchy::ROOT).unwrap();
    for side in [front, back] {
        let shape = hierarchy.shape(side);
        assert_eq!(hierarchy.node(side).facet_count, 128);
        assert!(shape.cone.half_angle < 1.0e-6);
        assert!((shape.area_vector.z.abs() - 1.0).abs() < 1.0e-6);
    }
}

#[test]
fn separate_specks_make_a_shallow_tree() {
    let mut random = Random::new(11);
    let mut mesh = Mesh::default();
    for _ in 0..20_000 {
        let at = Vec3::new(random.unit(), random.unit(), random.unit());
        let base = mesh.positions.len() as u32;
        for _ in 0..3 {
            let away = Vec3::new(random.unit(), random.unit(), random.unit());
            mesh.positions.push(at + 0.001 * away);
        }
        mesh.triangles.push([base, base + 1, base + 2]);
    }
    let scene = mesh.scene();
    let hierarchy = build(&scene, &fronts(&scene));
    assert!(depth(&hierarchy) <= 40, "{}", depth(&hierarchy));
}

#[test]
fn coinciding_specks_make_a_shallow_tree() {
    let mut mesh = Mesh::default();
    for copy in 0..5_000 {
        let base = 3 * copy;
        mesh.positions.extend([Vec3::ZERO, Vec3::X, Vec3::Y]);
        mesh.triangles.push([base, base + 1, base + 2]);
    }
    let scene = mesh.scene();
    let hierarchy = build(&scene, &fronts(&scene));
    assert!(depth(&hierarchy) <= 14, "{}", depth(&hierarchy));
}

#[test]
fn a_fine_grid_makes_a_shallow_tree() {
    let scene = meshes::grid(Vec3::ZERO, Vec3::X, Vec3::Y, 128, 128).scene();
    let hierarchy = build(&scene, &fronts(&scene));
    assert!(depth(&hierarchy) <= 30, "{}", depth(&hierarchy));
}

/// Triangles that stand on the edge of one long triangle and touch nothing else.
fn comb(teeth: u32, lean: f32) -> Mesh {
    let mut mesh = Mesh {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::new(0.5, -0.5, 0.0)],
        triangles: vec![[1, 0, 2]],
    };
    for tooth in 0..teeth {
        let left = tooth as f32 / teeth as f32;
        let right = left + 0.75 / teeth as f32;
        let base = mesh.positions.len() as u32;
        mesh.positions.extend([
            Vec3::X * left,
            Vec3::X * right,
            Vec3::new(left, lean.cos() * 0.25, lean.sin() * 0.25),
        ]);
        mesh.triangles.push([base, base + 1, base + 2]);
    }
    mesh
}

#[test]
fn a_comb_is_one_piece_and_no_chain() {
    for lean in [0.0, 0.1, 1.0, 3.0] {
        let scene = comb(5_000, lean).scene();
        for facets in [fronts(&scene), both_sides(&scene)] {
            let hierarchy = build(&scene, &facets);
            assert!(depth(&hierarchy) <= 64, "{}", depth(&hierarchy));
            let one_sided = facets.len() == scene.polygons.len();
            let root = hierarchy.node(Hierarchy::ROOT).kind;
            assert_eq!(root == NodeKind::FaceCluster, one_sided);
        }
    }
}

#[test]
fn a_book_is_no_chain() {
    let mut mesh = Mesh {
        positions: vec![Vec3::ZERO, Vec3::Z],
        triangles: Vec::new(),
    };
    for page in 0..5_000_u32 {
        let angle = page as f32 * 0.0011;
        mesh.positions
            .push(Vec3::new(angle.cos(), angle.sin(), 0.5));
        mesh.triangles.push([0, 1, page + 2]);
    }
    let scene = mesh.scene();
    let hierarchy = build(&scene, &both_sides(&scene));
    assert!(depth(&hierarchy) <= 80, "{}", depth(&hierarchy));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// Soups on a coarse lattice: duplicates, needles, non-manifold edges, everything at once.
    #[test]
    fn any_soup_gives_a_valid_hierarchy(
        triangles in prop::collection::vec([0_u32..27, 0_u32..27, 0_u32..27], 1..60),
        two_sided: bool,
        squash in 0_u32..4,
    ) {
        let height = [1.0, 1.0e-3, 1.0e-6, 1.0e-7][squash as usize];
        let positions = (0..27)
            .map(|i| Vec3::new((i % 3) as f32, (i / 3 % 3) as f32, (i / 9) as f32 * height) * 0.25)
            .collect();
        let scene = Mesh { positions, triangles }.scene();
        let facets = if two_sided { both_sides(&scene) } else { fronts(&scene) };
        build(&scene, &facets);
    }
}
