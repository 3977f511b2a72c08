//! Small solved scenes for the tests of this module, made without the loader or the solver.

use super::SolvedMesh;
use crate::math::{PolygonId, hash_u64};
use crate::scene::{Facet, Normalisation, Polygon, Scene, Side, Surface};
use crate::solve::{PatchPath, Solution, SolvedPatch};
use glam::DVec3;

/// A scene of triangles `(vertices, source face, surface)` over `positions`.
pub(crate) fn scene(
    positions: Vec<DVec3>,
    triangles: &[([u32; 3], u32, u32)],
    surfaces: Vec<Surface>,
) -> Scene {
    let (least, greatest) = positions.iter().fold(
        (DVec3::INFINITY, DVec3::NEG_INFINITY),
        |(least, greatest), &p| (least.min(p), greatest.max(p)),
    );
    let normalisation = Normalisation {
        centre: 0.5 * (least + greatest),
        scale: (-(greatest - least).max_element().log2().ceil()).exp2(),
        turn: glam::DMat3::IDENTITY,
    };
    Scene {
        name: "fixture".to_owned(),
        positions: positions
            .iter()
            .map(|&p| normalisation.to_normalised(p))
            .collect(),
        source_positions: positions,
        polygons: triangles
            .iter()
            .map(|&(vertices, source_face, surface)| Polygon {
                vertices,
                source_face,
                surface,
            })
            .collect(),
        surfaces,
        normalisation,
        source_faces: triangles.iter().map(|t| t.1 + 1).max().unwrap_or(0),
        dropped_faces: Vec::new(),
        contacts: crate::scene::Contacts::default(),
        warnings: Vec::new(),
    }
}

/// A grey surface.
pub(crate) fn grey(reflectance: f64, emission: f64) -> Surface {
    Surface {
        material: format!("grey_{reflectance}_{emission}"),
        reflectance: [reflectance; 3],
        emission: [emission; 3],
    }
}

/// The six quads of a box seen from inside, two triangles a quad; `source_face` counts quads in the
/// order -x, +x, -y, +y, -z, +z.
pub(crate) fn room(least: DVec3, greatest: DVec3, surface: Surface) -> Scene {
    let positions = box_corners(least, greatest);
    scene(positions, &box_triangles(0), vec![surface])
}

/// The corners of a box; bit 0, 1, 2 of the index choose the greater x, y, z.
pub(crate) fn box_corners(least: DVec3, greatest: DVec3) -> Vec<DVec3> {
    (0..8u32)
        .map(|i| {
            DVec3::new(
                if i & 1 == 0 { least.x } else { greatest.x },
                if i & 2 == 0 { least.y } else { greatest.y },
                if i & 4 == 0 { least.z } else { greatest.z },
            )
        })
        .collect()
}

/// The sides of the box whose corners start at `first`, facing inwards, numbered as in [`room`].
pub(crate) fn box_triangles(first: u32) -> Vec<([u32; 3], u32, u32)> {
    let quads: [[u32; 4]; 6] = [
        [0, 2, 6, 4],
        [1, 5, 7, 3],
        [0, 4, 5, 1],
        [2, 3, 7, 6],
        [0, 1, 3, 2],
        [4, 6, 7, 5],
    ];
    (0u32..)
        .zip(quads)
        .flat_map(|(f, quad)| {
            let [a, b, c, d] = quad.map(|v| v + first);
            [([a, b, c], f, 0), ([a, c, d], f, 0)]
        })
        .collect()
}

/// Splits the given facets at random, to `depth` at most, and gives each leaf the light that
/// `light` returns for its facet and corners (normalised): `(radiosity, irradiance)`.
pub(crate) fn solve(
    scene: &Scene,
    facets: Vec<Facet>,
    depth: u32,
    light: impl Fn(Facet, [glam::Vec3; 3]) -> (f32, f32),
) -> Solution {
    let mut solution = Solution {
        facets: Vec::new(),
        patches: Vec::new(),
        first_patch: vec![0],
    };
    for (f, facet) in facets.into_iter().enumerate() {
        let mut stack = vec![PatchPath::ROOT];
        while let Some(path) = stack.pop() {
            let chance = hash_u64(path.0 ^ hash_u64(f as u64)) % 3;
            if path.level() < depth && chance != 0 {
                stack.extend((0..4).rev().map(|which| path.child(which)));
                continue;
            }
            let (radiosity, irradiance) = light(facet, path.corners(scene.facet_corners(facet)));
            solution.patches.push(SolvedPatch {
                path,
                radiosity: [radiosity, 0.5 * radiosity, 0.25 * radiosity],
                irradiance: [irradiance; 3],
            });
        }
        solution.facets.push(facet);
        solution.first_patch.push(solution.patches.len() as u32);
    }
    solution
}

/// The front of every polygon.
pub(crate) fn fronts(scene: &Scene) -> Vec<Facet> {
    (0..scene.polygons.len())
        .map(|p| Facet {
            polygon: PolygonId::new(p),
            side: Side::Front,
        })
        .collect()
}

/// A square of two triangles in the plane z = 0 and a wall on its edge x = 0, split at random,
/// each patch with an irradiance of its own: the floor's in [1, 2), the wall's in [5, 6).
pub(crate) fn floor_and_wall() -> SolvedMesh {
    let corner = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
    let scene = scene(
        vec![
            corner(0.0, 0.0, 0.0),
            corner(1.0, 0.0, 0.0),
            corner(1.0, 1.0, 0.0),
            corner(0.0, 1.0, 0.0),
            corner(0.0, 0.0, 1.0),
            corner(0.0, 1.0, 1.0),
        ],
        &[
            ([0, 1, 2], 0, 0),
            ([0, 2, 3], 0, 0),
            ([0, 3, 5], 1, 0),
            ([0, 5, 4], 1, 0),
        ],
        vec![grey(0.5, 0.0)],
    );
    let solution = solve(&scene, fronts(&scene), 6, |facet, corners| {
        let bits = (corners[0] + corners[1] + corners[2])
            .to_array()
            .map(|x| u64::from(x.to_bits()))
            .into_iter()
            .fold(0, |key, x| hash_u64(key ^ x));
        let own = (bits >> 40) as f32 / (1u64 << 24) as f32;
        let irradiance = own + if facet.polygon.0 < 2 { 1.0 } else { 5.0 };
        (0.5 * irradiance, irradiance)
    });
    SolvedMesh::new(&scene, &solution)
}
