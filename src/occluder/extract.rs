//! The extraction: every stage of the paper's section 3.2, one line each.

use super::bounding_rectangle::smallest_rectangle_axis;
use super::candidate::flat_clusters;
use super::config::OccluderConfig;
use super::footprint::Footprint;
use super::grow::grow_rectangles;
use super::rectangle::{Rectangle, union_area};
use super::set::{Occluder, OccluderSet, OccluderStatistics};
use super::sheet::Sheet;
use super::solid_search::find_solids;
use super::thicken::thicken;
use crate::cluster::Hierarchy;
use crate::math::NodeId;
use crate::scene::Scene;
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use std::time::Instant;

/// The weld distance w as a fraction of the scene's diagonal: cracks narrower than about half of it
/// count as closed, and no claim is made about segments within w of a polygon.
const WELD: f64 = 1.0e-6;

/// What a rectangle may lose at a side, in w, to edges out of line by f32 rounding, which is up to
/// 0.06 w.
const SLACK_SHARE: f64 = 0.1;

/// A rectangle with more than this share of its area inside a larger one proves nothing that the
/// larger does not; slanted walls would give several such.
const SAME: f64 = 0.99;

/// Any direction unlikely to lie half-way between the axes of a wall: rectangles are named "along"
/// and "across" by it, the same way however the wall is meshed.
const LONGWAYS: DVec3 = DVec3::new(0.935, 0.298, 0.192);

/// Extracts the occluders of a scene: the same ones, in the same order, at any number of threads.
pub fn extract_occluders(
    scene: &Scene,
    hierarchy: &Hierarchy,
    config: &OccluderConfig,
) -> OccluderSet {
    let start = Instant::now();
    let diagonal = f64::from(scene.bounds().diagonal());
    let scale = Scale {
        weld: WELD * diagonal,
        min_area: config.min_area * diagonal * diagonal,
    };
    let clusters: Vec<ClusterOccluders> = flat_clusters(scene, hierarchy, config)
        .into_par_iter()
        .map(|node| extract_cluster(scene, hierarchy, node, config, scale).unwrap_or_default())
        .collect();
    let mut set = OccluderSet::default();
    for cluster in clusters {
        set.statistics = add(set.statistics, &cluster);
        set.occluders.extend(cluster.occluders);
    }
    set.seconds.rectangles = start.elapsed().as_secs_f64();
    if config.solids {
        let start = Instant::now();
        set.solids = find_solids(scene, &set.occluders, scale.weld);
        set.seconds.solids = start.elapsed().as_secs_f64();
    }
    set
}

/// Sizes in normalised units.
#[derive(Clone, Copy)]
struct Scale {
    weld: f64,
    min_area: f64,
}

/// What one flat cluster gives; areas in normalised units squared.
#[derive(Default)]
struct ClusterOccluders {
    occluders: Vec<Occluder>,
    footprint_area: f64,
    covered_area: f64,
    rejected: usize,
}

fn extract_cluster(
    scene: &Scene,
    hierarchy: &Hierarchy,
    node: NodeId,
    config: &OccluderConfig,
    scale: Scale,
) -> Option<ClusterOccluders> {
    let sheet = Sheet::new(scene, &hierarchy.facets[hierarchy.facet_range(node)])?;
    let footprint = Footprint::new(&sheet, scale.weld);
    let longways = DVec2::new(sheet.frame.u.dot(LONGWAYS), sheet.frame.v.dot(LONGWAYS));
    let axis = smallest_rectangle_axis(&footprint.edges, longways)?;
    let (footprint, frame) = (footprint.turned(axis), sheet.frame.turned(axis));
    let bounds = footprint.bounds()?;
    let mut grown = grow_rectangles(
        &footprint,
        bounds,
        config.per_cluster,
        scale.min_area,
        SLACK_SHARE * scale.weld,
    );
    grown.sort_by(|a, b| b.area().total_cmp(&a.area()));

    let mut found = ClusterOccluders {
        footprint_area: footprint.area(),
        ..Default::default()
    };
    let mut kept: Vec<Rectangle> = Vec::new();
    for rectangle in grown {
        if !footprint.covers_rectangle(&rectangle) {
            found.rejected += 1;
            continue;
        }
        if kept
            .iter()
            .any(|k| k.overlap(&rectangle) > SAME * rectangle.area())
        {
            continue;
        }
        let slab = thicken(
            &sheet,
            &footprint,
            &frame,
            rectangle,
            scale.weld,
            config.flush,
            node,
        );
        if let Some(occluder) = slab {
            kept.push(rectangle);
            found.occluders.push(occluder);
        }
    }
    found.covered_area = union_area(&kept);
    Some(found)
}

fn add(sum: OccluderStatistics, cluster: &ClusterOccluders) -> OccluderStatistics {
    OccluderStatistics {
        flat_clusters: sum.flat_clusters + 1,
        productive_clusters: sum.productive_clusters + usize::from(!cluster.occluders.is_empty()),
        occluders: sum.occluders + cluster.occluders.len(),
        flat_area: sum.flat_area + cluster.footprint_area,
        covered_area: sum.covered_area + cluster.covered_area,
        rejected: sum.rejected + cluster.rejected,
    }
}
