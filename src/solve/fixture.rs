//! Scenes built by hand for the tests of this stage.

use super::config::Technique;
use super::prepared::{PreparedScene, StageSeconds};
use crate::cluster::{ClusterConfig, build_hierarchy};
use crate::embree::{CommittedScene, Device, DeviceConfig};
use crate::math::PolygonId;
use crate::occluder::OccluderConfig;
use crate::scene::{Facet, Normalisation, Polygon, Scene, Side, Surface};
use glam::{DVec3, Vec3};

/// A grey surface.
pub fn grey(reflectance: f64, emission: f64) -> Surface {
    Surface {
        material: "grey".to_owned(),
        reflectance: [reflectance; 3],
        emission: [emission; 3],
    }
}

/// An empty scene with one power of two of scale and no offset: positions are normalised ones.
pub fn scene(surfaces: Vec<Surface>) -> Scene {
    Scene {
        name: "fixture".to_owned(),
        positions: Vec::new(),
        source_positions: Vec::new(),
        polygons: Vec::new(),
        surfaces,
        normalisation: Normalisation {
            centre: DVec3::ZERO,
            scale: 1.0,
            turn: glam::DMat3::IDENTITY,
        },
        source_faces: 0,
        dropped_faces: Vec::new(),
        contacts: crate::scene::Contacts::default(),
        warnings: Vec::new(),
    }
}

/// Adds a parallelogram of `cells` x `cells` quads, its front along u x v.
pub fn add_plate(scene: &mut Scene, corner: Vec3, u: Vec3, v: Vec3, cells: u32, surface: u32) {
    let base = scene.positions.len() as u32;
    for j in 0..=cells {
        for i in 0..=cells {
            let p = corner + u * (i as f32 / cells as f32) + v * (j as f32 / cells as f32);
            scene.positions.push(p);
            scene.source_positions.push(p.as_dvec3());
        }
    }
    for j in 0..cells {
        for i in 0..cells {
            let a = base + j * (cells + 1) + i;
            let (b, c, d) = (a + 1, a + cells + 2, a + cells + 1);
            for vertices in [[a, b, c], [a, c, d]] {
                scene.polygons.push(Polygon {
                    vertices,
                    source_face: scene.source_faces,
                    surface,
                });
            }
            scene.source_faces += 1;
        }
    }
}

/// Adds the six walls of the box, their fronts inward (or outward); walls in the order -x +x -y +y -z +z.
pub fn add_box(
    scene: &mut Scene,
    lo: Vec3,
    hi: Vec3,
    cells: u32,
    surfaces: [u32; 6],
    inward: bool,
) {
    let e = hi - lo;
    for axis in 0..3 {
        let (a, b) = ((axis + 1) % 3, (axis + 2) % 3);
        let mut u = Vec3::ZERO;
        let mut v = Vec3::ZERO;
        u[a] = e[a];
        v[b] = e[b];
        for high in [false, true] {
            let mut corner = lo;
            if high {
                corner[axis] = hi[axis];
            }
            // u x v points along +axis: inward for the low wall.
            let (first, second) = if high == inward { (v, u) } else { (u, v) };
            add_plate(
                scene,
                corner,
                first,
                second,
                cells,
                surfaces[2 * axis + usize::from(high)],
            );
        }
    }
}

/// The fronts of every polygon.
pub fn fronts(scene: &Scene) -> Vec<Facet> {
    (0..scene.polygons.len())
        .map(|p| Facet {
            polygon: PolygonId::new(p),
            side: Side::Front,
        })
        .collect()
}

/// The fronts of a scene, ready to be solved with guarantees.
pub fn prepare(scene: &Scene) -> PreparedScene {
    let device = Device::new(&DeviceConfig::default()).expect("Embree opens");
    let triangles: Vec<[u32; 3]> = scene.polygons.iter().map(|p| p.vertices).collect();
    PreparedScene {
        hierarchy: build_hierarchy(scene, &fronts(scene), &ClusterConfig::default()),
        embree: CommittedScene::build(&device, &scene.positions, &triangles).expect("commits"),
        embree_version: device.version(),
        scene: scene.clone(),
        guarantees: None,
        seconds: StageSeconds::default(),
    }
    .with_guarantees(Technique::Occlusion, &OccluderConfig::default())
}
