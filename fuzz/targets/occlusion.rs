//! No claim of full occlusion that exact arithmetic does not bear out, and none that a descendant's
//! rounding could break: by a rectangle, by a solid, or by a surface that the corners of both make.

#![no_main]

use certilux::math::Aabb;
use certilux::occluder::{SlabRectangle, Solid};
use certilux::visibility::exact::{
    replay_occlusion, replay_solid_occlusion, replay_surface_occlusion,
};
use certilux::visibility::{
    BoundsShape, ElementBounds, OccluderTree, OcclusionScratch, SceneTree, SurfaceEdges,
    SurfaceQuery, SurfaceScratch, Tolerance,
};
use certilux_fuzz::{Bytes, element, slab};
use glam::Vec3;
use libfuzzer_sys::fuzz_target;

/// The corners moved each its own way, by almost what descendants may stray.
fn strayed(bounds: &ElementBounds, bytes: &mut Bytes, step: f32) -> ElementBounds {
    let corners: Vec<Vec3> = bounds
        .corners()
        .map(|c| c + bytes.point().normalize_or_zero() * step)
        .collect();
    // Boxes and slabs as loose corners: the replay only asks for corners.
    ElementBounds::from_polygon(&corners)
}

/// A box with the rectangle as a face.
fn solid_under(slab: &SlabRectangle, bytes: &mut Bytes) -> Solid {
    let [a, b, c, d] = slab.corners;
    let depth = slab.normal * bytes.point().x;
    Solid {
        centre: 0.5 * (a + c) + depth,
        halves: [depth, 0.5 * (b - a), 0.5 * (d - a)],
        covered: std::array::from_fn(|_| [(); 2].map(|()| bytes.below(4) != 0)),
    }
}

fuzz_target!(|data: &[u8]| {
    let bytes = &mut Bytes::new(data);
    let slabs: Vec<_> = (0..=bytes.below(10)).map(|_| slab(bytes)).collect();
    let (a, b) = (element(bytes), element(bytes));
    let cube = Aabb {
        min: Vec3::splat(-0.5),
        max: Vec3::splat(0.5),
    };
    let tolerance = Tolerance::of_scene(cube);
    let tree = OccluderTree::build(&slabs, &[], tolerance);
    let answer = tree.query(&a, &b, &mut None, &mut OcclusionScratch::default());
    let every = (0..slabs.len() as u32).filter(|&id| tree.occluded_by(id, &a, &b));
    let claims: Vec<u32> = every.collect();
    // What the walk finds, trying each finds too; and the other way round.
    assert_eq!(answer.occluder.is_some(), !claims.is_empty());
    for id in claims {
        let slab = &slabs[id as usize];
        assert_eq!(replay_occlusion(slab, &a, &b, &tolerance), Ok(()));
        if a.shape() != BoundsShape::Box {
            let a = strayed(&a, bytes, 0.9 * tolerance.nesting);
            let b = strayed(&b, bytes, 0.9 * tolerance.nesting);
            assert_eq!(replay_occlusion(slab, &a, &b, &tolerance), Ok(()));
        }
    }
    // Triangles between their corners hang together at many edges.
    let corners: Vec<Vec3> = slabs.iter().flat_map(|slab| slab.corners).collect();
    let mut corner = || corners[bytes.below(corners.len())];
    let triangles: Vec<[Vec3; 3]> = (0..24)
        .map(|_| [corner(), corner(), corner()])
        .filter(|[u, v, w]| (*v - *u).cross(*w - *u).length() > 0.0)
        .collect();
    let scene = SceneTree::over_triangles(&triangles, tolerance);
    let edges = SurfaceEdges::new(triangles);
    let query = SurfaceQuery::new(&scene, &edges);
    if let Some(seed) = query.run(&a, &b, &mut SurfaceScratch::default()).surface {
        let surface = query.surface(&a, &b, seed).expect("found again");
        assert_eq!(replay_surface_occlusion(&surface, &a, &b, &tolerance), Ok(()));
    }
    // The boxes under the rectangles, some of their faces open.
    let solids: Vec<Solid> = slabs.iter().map(|slab| solid_under(slab, bytes)).collect();
    let tree = OccluderTree::build(&[], &solids, tolerance);
    let answer = tree.query_solids(&a, &b, &mut None, &mut OcclusionScratch::default());
    let every = (0..solids.len() as u32).filter(|&id| tree.occluded_by(id, &a, &b));
    let claims: Vec<u32> = every.collect();
    // The walk tries those that the segment between the centres meets up to rounding.
    assert!(answer.occluder.is_none() || !claims.is_empty());
    for id in claims {
        let solid = &solids[id as usize];
        assert_eq!(replay_solid_occlusion(solid, &a, &b, &tolerance), Ok(()));
        if a.shape() != BoundsShape::Box {
            let a = strayed(&a, bytes, 0.9 * tolerance.nesting);
            let b = strayed(&b, bytes, 0.9 * tolerance.nesting);
            assert_eq!(replay_solid_occlusion(solid, &a, &b, &tolerance), Ok(()));
        }
    }
});
