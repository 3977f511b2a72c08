//! Time of the guaranteed tests, one thread: `cargo bench --bench visibility_kernels [SCENE]`
//! (default `offices`) prints CSV.
//!
//! The pairs are those that a solver would meet: from the pair (root, root) the larger element is
//! split again and again and one child is drawn, so pairs of all levels come up. Times are processor
//! times of the thread, the least of the repeats.

use certilux::cluster::{ClusterConfig, Hierarchy, NodeKind, build_hierarchy};
use certilux::math::{NodeId, PolygonId, hash_u64};
use certilux::occluder::{OccluderConfig, SlabRectangle, extract_occluders};
use certilux::scene::generate::generate;
use certilux::scene::{Facet, LoadConfig, Scene, Side, load_text};
use certilux::visibility::{
    ElementBounds, OccluderTree, OcclusionScratch, SceneTree, SurvivorList, Tolerance, Verdict,
    VisibilityQuery, VisibilityScratch, WalkLimits,
};
use std::hint::black_box;
use std::sync::LazyLock;
use std::time::Instant;

/// Least of this many repeats.
const REPEATS: usize = 7;
/// Descents from the root.
const CHAINS: u64 = 3_000;

struct Stage {
    scene: Scene,
    hierarchy: Hierarchy,
    slabs: Vec<SlabRectangle>,
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if arguments.iter().any(|a| a == "--test") {
        return;
    }
    let name = arguments
        .iter()
        .find(|a| !a.starts_with('-'))
        .map_or("offices", String::as_str);
    let stage = stage(name);
    let chains: Vec<Vec<(ElementBounds, ElementBounds)>> =
        (0..CHAINS).map(|seed| chain(&stage, seed)).collect();
    let pairs: usize = chains.iter().map(Vec::len).sum();
    println!(
        "scene,polygons,occluders,pairs,kernel,ns_per_query,nodes_per_query,slow_per_query,proved_percent"
    );
    let row = |kernel: &str, seconds: f64, counts: [u64; 3], queries: usize| {
        let per = |x: u64| x as f64 / queries as f64;
        println!(
            "{name},{},{},{queries},{kernel},{:.1},{:.2},{:.2},{:.1}",
            stage.scene.polygons.len(),
            stage.slabs.len(),
            seconds * 1e9 / queries as f64,
            per(counts[0]),
            per(counts[1]),
            100.0 * per(counts[2])
        );
    };
    let tolerance = Tolerance::of_scene(stage.scene.bounds());
    let occluders = OccluderTree::build(&stage.slabs, tolerance);
    let (seconds, counts) = least(|| occlusion(&occluders, &chains));
    row("occlusion", seconds, counts, pairs);
    let start = Instant::now();
    let tree = SceneTree::build(&stage.scene);
    row(
        "scene tree build",
        start.elapsed().as_secs_f64(),
        [0; 3],
        stage.scene.polygons.len(),
    );
    let (seconds, counts) = least(|| visibility(&tree, &chains, false));
    row("visibility, whole scene", seconds, counts, pairs);
    let (seconds, counts) = least(|| visibility(&tree, &chains, true));
    row("visibility, inherited lists", seconds, counts, pairs);
}

fn stage(name: &str) -> Stage {
    let text = generate(name).expect("a built-in scene");
    let library = format!("{name}.mtl");
    let files = [(library.as_str(), text.mtl.as_bytes())];
    let scene = load_text(name, text.obj.as_bytes(), &files, &LoadConfig::default())
        .expect("built-in scenes are valid");
    let facets: Vec<Facet> = (0..scene.polygons.len())
        .map(|i| Facet {
            polygon: PolygonId::new(i),
            side: Side::Front,
        })
        .collect();
    let hierarchy = build_hierarchy(&scene, &facets, &ClusterConfig::default());
    let set = extract_occluders(&scene, &hierarchy, &OccluderConfig::default());
    Stage {
        slabs: set.occluders.iter().map(|o| o.slab).collect(),
        scene,
        hierarchy,
    }
}

fn bounds_of(stage: &Stage, node: NodeId) -> ElementBounds {
    match stage.hierarchy.node(node).kind {
        NodeKind::Facet => {
            let facet = stage.hierarchy.facets[stage.hierarchy.facet_of_leaf(node).index()];
            ElementBounds::from_polygon(&stage.scene.facet_corners(facet))
        }
        _ => ElementBounds::from_box(stage.hierarchy.node(node).bounds),
    }
}

/// Pairs of one descent, from the first whose boxes are disjoint.
fn chain(stage: &Stage, seed: u64) -> Vec<(ElementBounds, ElementBounds)> {
    let mut random = hash_u64(seed);
    let mut pair = [Hierarchy::ROOT; 2];
    let mut pairs = Vec::new();
    loop {
        let size = |n: NodeId| stage.hierarchy.node(n).bounds.surface_area();
        let larger = usize::from(size(pair[1]) > size(pair[0]));
        let at = [larger, 1 - larger]
            .into_iter()
            .find(|&i| stage.hierarchy.children(pair[i]).is_some());
        let Some(at) = at else { break };
        let children = stage.hierarchy.children(pair[at]).expect("checked above");
        random = hash_u64(random);
        pair[at] = children[(random & 1) as usize];
        let (a, b) = (bounds_of(stage, pair[0]), bounds_of(stage, pair[1]));
        if a.aabb().distance(b.aabb()) > 0.0 {
            pairs.push((a, b));
        }
    }
    pairs
}

fn least(run: impl Fn() -> [u64; 3]) -> (f64, [u64; 3]) {
    let mut best = f64::INFINITY;
    let mut counts = [0; 3];
    for _ in 0..REPEATS {
        let start = processor_seconds();
        counts = black_box(run());
        best = best.min(processor_seconds() - start);
    }
    (best, counts)
}

/// Time that this thread has had a processor, where the kernel says so; else wall time.
fn processor_seconds() -> f64 {
    static ORIGIN: LazyLock<Instant> = LazyLock::new(Instant::now);
    std::fs::read_to_string("/proc/thread-self/schedstat")
        .ok()
        .and_then(|text| text.split(' ').next()?.parse::<f64>().ok())
        .map_or_else(|| ORIGIN.elapsed().as_secs_f64(), |ns| ns * 1e-9)
}

type Chains = [Vec<(ElementBounds, ElementBounds)>];

fn occlusion(tree: &OccluderTree, chains: &Chains) -> [u64; 3] {
    let mut scratch = OcclusionScratch::default();
    let mut counts = [0; 3];
    for chain in chains {
        let mut last = None;
        for (a, b) in chain {
            let answer = tree.query(a, b, &mut last, &mut scratch);
            counts[0] += u64::from(answer.nodes);
            counts[1] += u64::from(answer.tests);
            counts[2] += u64::from(answer.occluder.is_some());
        }
    }
    counts
}

fn visibility(tree: &SceneTree, chains: &Chains, inherit: bool) -> [u64; 3] {
    let query = VisibilityQuery::new(tree);
    let whole = SurvivorList::whole_scene(tree);
    let mut scratch = VisibilityScratch::default();
    let mut lists = [SurvivorList::new(), SurvivorList::new()];
    let mut counts = [0; 3];
    for chain in chains {
        lists[0].clone_from(&whole);
        for (a, b) in chain {
            let [incoming, outgoing] = &mut lists;
            let answer = query.run(
                a,
                b,
                incoming,
                outgoing,
                WalkLimits::default(),
                &mut scratch,
            );
            counts[0] += u64::from(answer.nodes);
            counts[1] += u64::from(answer.polygons);
            counts[2] += u64::from(answer.verdict == Verdict::Visible);
            if inherit {
                lists.swap(0, 1);
            }
        }
    }
    counts
}
