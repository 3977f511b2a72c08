//! Where rays were needed, as numbers of a solution's patches.

use super::solved_mesh::in_file_order;
use crate::cluster::Hierarchy;
use crate::math::{FacetId, NodeId};
use crate::scene::Scene;
use crate::solve::{ElementName, PatchPath, Solution};
use std::collections::HashMap;

/// Rays through Embree by the receiver that they were cast for.
#[derive(Clone, Debug, Default)]
pub struct RaysByReceiver(HashMap<(NodeId, PatchPath), u64>);

impl RaysByReceiver {
    /// Adds rays of one receiver.
    pub fn add(&mut self, receiver: ElementName, rays: u32) {
        *self.0.entry((receiver.node, receiver.path)).or_default() += u64::from(rays);
    }

    /// All of them.
    pub fn total(&self) -> u64 {
        self.0.values().sum()
    }
}

/// Rays per square of the file's unit on every face of the mesh of `solution`, in the mesh's order. The rays of a
/// receiver are spread evenly over it: over all patches of a cluster, over the patches into which a coarser receiver was
/// split later, and where a receiver was finer than the patch at last, over the whole of that.
pub fn ray_density(
    scene: &Scene,
    hierarchy: &Hierarchy,
    solution: &Solution,
    rays: &RaysByReceiver,
) -> Vec<Option<f64>> {
    // A cluster's rays per area fall on each of its facets.
    let mut on_facet = vec![0.0f64; hierarchy.facets.len()];
    let mut on_patch: Vec<HashMap<PatchPath, u64>> = vec![HashMap::new(); hierarchy.facets.len()];
    for (&(node, path), &count) in &rays.0 {
        let facets = hierarchy.facet_range(node);
        if facets.len() == 1 {
            *on_patch[facets.start].entry(path).or_default() += count;
        }
    }
    // In the order of nodes, so that sums have the same bits every time.
    let mut clusters: Vec<(NodeId, u64)> = (rays.0.iter())
        .filter(|((node, _), _)| hierarchy.facet_range(*node).len() > 1)
        .map(|(&(node, _), &count)| (node, count))
        .collect();
    clusters.sort_unstable();
    for (node, count) in clusters {
        let area = f64::from(hierarchy.shape(node).area);
        for density in &mut on_facet[hierarchy.facet_range(node)] {
            *density += count as f64 / area;
        }
    }
    let mut densities = Vec::with_capacity(solution.patches.len());
    for (facet, id) in in_file_order(scene, solution) {
        let Some(id) = id else {
            densities.push(None);
            continue;
        };
        let whole = scene.polygon_area(facet.polygon);
        let patches = solution.facet_patches(id);
        let finer = finer_than_leaves(&on_patch[id.index()], patches.iter().map(|p| p.path));
        for patch in patches {
            let mut density = on_facet[FacetId::index(id)];
            let mut path = patch.path;
            loop {
                let area = whole * 0.25f64.powi(path.level() as i32);
                let own = on_patch[id.index()].get(&path).copied().unwrap_or(0);
                let below = match path == patch.path {
                    true => finer.get(&path).copied().unwrap_or(0),
                    false => 0,
                };
                density += (own + below) as f64 / area;
                if path == PatchPath::ROOT {
                    break;
                }
                path = PatchPath(path.0 >> 2);
            }
            densities.push(Some(density / scene.normalisation.area_to_file(1.0)));
        }
    }
    densities
}

/// Rays of receivers that are finer than the leaf that holds them, by that leaf.
fn finer_than_leaves(
    rays: &HashMap<PatchPath, u64>,
    leaves: impl Iterator<Item = PatchPath>,
) -> HashMap<PatchPath, u64> {
    let leaves: std::collections::HashSet<PatchPath> = leaves.collect();
    let mut finer = HashMap::new();
    for (&path, &count) in rays {
        let mut above = path;
        while above != PatchPath::ROOT {
            above = PatchPath(above.0 >> 2);
            if leaves.contains(&above) {
                *finer.entry(above).or_default() += count;
                break;
            }
        }
    }
    finer
}

#[cfg(test)]
mod tests {
    use super::super::SolvedMesh;
    use super::*;
    use crate::embree::DeviceConfig;
    use crate::occluder::OccluderConfig;
    use crate::scene::generate::generate;
    use crate::scene::{LoadConfig, SidesMode, load_text};
    use crate::solve::{Observer, PreparedScene, SolveConfig, solve};
    use std::sync::Mutex;

    #[derive(Default)]
    struct Counter(Mutex<RaysByReceiver>);

    impl Observer for Counter {
        fn counts_rays(&self) -> bool {
            true
        }
        fn rays_cast(&self, receiver: ElementName, rays: u32) {
            self.0.lock().unwrap().add(receiver, rays);
        }
    }

    #[test]
    fn every_ray_of_a_solve_is_spread_over_its_receiver() {
        let text = generate("cornell").unwrap();
        let library = format!("{}.mtl", text.name);
        let scene = load_text(
            "cornell",
            text.obj.as_bytes(),
            &[(&library, text.mtl.as_bytes())],
            &LoadConfig::default(),
        )
        .unwrap();
        let config = SolveConfig {
            epsilon: 1.0e-4,
            gradient: 0.05,
            ..SolveConfig::default()
        };
        let prepared = PreparedScene::new(scene, SidesMode::Auto, 1, &DeviceConfig::default())
            .unwrap()
            .with_guarantees(config.technique, &OccluderConfig::default());
        let counter = Counter::default();
        let solved = solve(&prepared, &config, &counter).unwrap();
        let rays = counter.0.into_inner().unwrap();
        let counted: u64 = solved.passes.iter().map(|p| p.rays).sum();
        assert_eq!(rays.total(), counted);
        assert!(counted > 10_000);
        let (scene, hierarchy) = (&prepared.scene, &prepared.hierarchy);
        let density = ray_density(scene, hierarchy, &solved.solution, &rays);
        let mesh = SolvedMesh::new(scene, &solved.solution);
        assert_eq!(density.len(), mesh.faces.len());
        let spread: f64 = (mesh.faces.iter().zip(&density))
            .map(|(face, density)| mesh.area(face) * density.unwrap_or(0.0))
            .sum();
        assert!(
            (spread / counted as f64 - 1.0).abs() < 1e-4,
            "{spread} of {counted}"
        );
        // Sides that receive light needed some, and not all the same.
        let (least, greatest) = density
            .iter()
            .flatten()
            .fold((f64::INFINITY, 0.0f64), |(l, g), &d| (l.min(d), g.max(d)));
        assert!(greatest > 2.0 * least, "{least} to {greatest}");
    }
}
