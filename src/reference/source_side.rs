//! One side of a source face: what the reference measures, and the unit of `REF.json`.

use super::random::key_of;
use super::traced_scene::TracedScene;
use super::weighted_choice::WeightedChoice;
use crate::math::PolygonId;
use crate::scene::{Facet, Side};
use glam::DVec3;
use std::collections::BTreeMap;

/// The facets that one face of the file has on one side.
#[derive(Clone, Debug)]
pub(super) struct SourceSide {
    /// 0-based index of the `f` statement, in file order.
    pub face: u32,
    pub side: Side,
    /// Area in the square of the file's units: facets, and on the front what has no lit side at all,
    /// which a solution shows as black.
    pub area: f64,
    /// Share of the area that its facets have.
    pub lit_share: f64,
    pub facets: Vec<Facet>,
    /// Chooses among the facets by area.
    pub by_area: WeightedChoice,
    pub reflectance: [f64; 3],
    /// Emitted radiance.
    pub emission: [f64; 3],
}

/// The sides to be measured, ordered by face, front before back; with `faces` a sample of so many faces,
/// the same for the same seed.
pub(super) fn source_sides(traced: &TracedScene, faces: Option<u32>, seed: u64) -> Vec<SourceSide> {
    let scene = &traced.scene;
    let face_of = |id: PolygonId| scene.polygons[id.index()].source_face;
    let mut groups: BTreeMap<(u32, Side), Vec<Facet>> = BTreeMap::new();
    for &facet in &traced.facets {
        let group = groups.entry((face_of(facet.polygon), facet.side));
        group.or_default().push(facet);
    }
    if let Some(count) = faces {
        let mut order: Vec<(u64, u32)> = groups
            .keys()
            .map(|&(face, _)| (key_of(&[seed, u64::from(face)]), face))
            .collect();
        order.dedup();
        order.sort_unstable();
        order.truncate(count as usize);
        let mut kept: Vec<u32> = order.into_iter().map(|(_, face)| face).collect();
        kept.sort_unstable();
        groups.retain(|(face, _), _| kept.binary_search(face).is_ok());
    }
    let area = |id: PolygonId| -> f64 {
        let [a, b, c]: [DVec3; 3] = scene.source_corners(id);
        0.5 * (b - a).cross(c - a).length()
    };
    let mut unlit: BTreeMap<u32, f64> = BTreeMap::new();
    for id in (0..scene.polygons.len()).map(PolygonId::new) {
        let dark = [Side::Front, Side::Back]
            .into_iter()
            .all(|side| !traced.facet_exists(Facet { polygon: id, side }));
        if dark {
            *unlit.entry(face_of(id)).or_default() += area(id);
        }
    }
    groups
        .into_iter()
        .map(|((face, side), facets)| {
            let by_area = WeightedChoice::new(facets.iter().map(|f| area(f.polygon)));
            let black = match side {
                Side::Front => unlit.get(&face).copied().unwrap_or(0.0),
                Side::Back => 0.0,
            };
            let whole = by_area.total() + black;
            let surface = scene.surface(facets[0].polygon);
            SourceSide {
                face,
                side,
                area: whole,
                lit_share: by_area.total() / whole,
                reflectance: surface.reflectance,
                emission: scene.emission(facets[0]),
                facets,
                by_area,
            }
        })
        .collect()
}
