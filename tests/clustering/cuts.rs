//! Cuts through the hierarchy, and the picture of them.

use crate::meshes::{both_sides, cuboid, sphere};
use certilux::cluster::{ClusterConfig, build_hierarchy};
use certilux::output::write_cluster_ply;
use glam::Vec3;
use std::collections::BTreeSet;
use std::sync::atomic::AtomicBool;

#[test]
fn a_cut_covers_every_facet_once() {
    let mut mesh = cuboid(Vec3::splat(-0.5), Vec3::splat(-0.2));
    mesh.append(&sphere(Vec3::splat(0.2), 0.3, 16));
    let scene = mesh.scene();
    let facets = both_sides(&scene);
    let hierarchy = build_hierarchy(&scene, &facets, &ClusterConfig::default());
    for count in [1, 2, 3, 10, 100, facets.len(), 10 * facets.len()] {
        let cut = hierarchy.cut(count);
        assert_eq!(cut.len(), count.min(facets.len()));
        let covered: Vec<_> = cut
            .iter()
            .flat_map(|&id| hierarchy.facet_range(id))
            .collect();
        assert!(covered.into_iter().eq(0..facets.len()));
    }
}

#[test]
fn a_cube_shows_six_colours() {
    let scene = cuboid(Vec3::splat(-0.5), Vec3::splat(0.5)).scene();
    let facets = crate::meshes::fronts(&scene);
    let hierarchy = build_hierarchy(&scene, &facets, &ClusterConfig::default());
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("clusters.ply");
    let count = write_cluster_ply(&path, &scene, &hierarchy, 6, &AtomicBool::new(false)).unwrap();
    assert_eq!(count, 6);
    let bytes = std::fs::read(&path).unwrap();
    let end = b"end_header\n";
    let start = bytes.windows(end.len()).position(|w| w == end).unwrap() + end.len();
    // Three doubles and three bytes a vertex; a list of three and 13 bytes more a face.
    let (vertex, face) = (27, 1 + 12 + 13);
    assert_eq!(bytes.len() - start, 36 * vertex + 12 * face);
    // One colour for each direction that the triangles face, and as many directions as colours.
    let mut colours = BTreeSet::new();
    let mut pairs = BTreeSet::new();
    for triangle in bytes[start..start + 36 * vertex].chunks(3 * vertex) {
        let corner = |i: usize| {
            let at = |axis: usize| {
                let from = i * vertex + 8 * axis;
                f64::from_le_bytes(triangle[from..from + 8].try_into().unwrap())
            };
            glam::DVec3::new(at(0), at(1), at(2))
        };
        let normal = (corner(1) - corner(0)).cross(corner(2) - corner(0));
        let colour = triangle[24..27].to_vec();
        colours.insert(colour.clone());
        pairs.insert((colour, normal.to_array().map(|x| x.round() as i32)));
    }
    assert_eq!((colours.len(), pairs.len()), (6, 6));
}
