//! Time of the guaranteed tests, one thread: `cargo bench --bench visibility_kernels [SCENE]`
//! (default `offices`) prints CSV.
//!
//! The pairs are those that a solver would meet: from the pair (root, root) the larger element is
//! split again and again and one child is drawn, down to patches of polygons, until one faces away
//! from the other; so pairs of all levels come up, most of them small. Inherited lists go down from
//! pair to pair, and a chain ends for them where a claim is made. Times are processor times of the
//! thread, the least of the repeats.

use certilux::cluster::{ClusterConfig, Hierarchy, NodeKind, build_hierarchy};
use certilux::math::{NodeId, PolygonId, hash_u64};
use certilux::occluder::{OccluderConfig, SlabRectangle, extract_occluders};
use certilux::scene::generate::generate;
use certilux::scene::{Facet, LoadConfig, Scene, Side, load_text};
use certilux::solve::split_triangle;
use certilux::visibility::{
    BlockerList, ElementBounds, OccluderTree, OcclusionScratch, SceneTree, SegmentOctet,
    SurvivorList, Tolerance, Verdict, VisibilityQuery, VisibilityScratch, WalkLimits,
};
use glam::Vec3;
use std::hint::black_box;
use std::sync::LazyLock;
use std::time::Instant;

/// Least of this many repeats.
const REPEATS: usize = 7;
/// Runs in a repeat: the processor clock may go in steps of milliseconds.
const RUNS: usize = 10;
/// Descents from the root.
const CHAINS: u64 = 3_000;
/// Lists filled and asked in a repeat.
const BLOCKER_RUNS: usize = 100_000;
/// Levels of patches below a polygon.
const PATCH_LEVELS: u32 = 4;

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
    println!(
        "scene,polygons,occluders,pairs,kernel,ns_per_query,nodes_per_query,slow_per_query,proved_percent"
    );
    let row = |kernel: &str, seconds: f64, counts: [u64; 4], queries: usize| {
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
    let occluders = OccluderTree::build(&stage.slabs, &[], tolerance);
    let (seconds, counts) = least(|| occlusion(&occluders, &chains));
    row("occlusion", seconds, counts, counts[3] as usize);
    let start = Instant::now();
    let tree = SceneTree::build(&stage.scene);
    row(
        "scene tree build",
        start.elapsed().as_secs_f64(),
        [0; 4],
        stage.scene.polygons.len(),
    );
    let (seconds, counts) = least(|| visibility(&tree, &chains, false));
    row(
        "visibility, whole scene",
        seconds,
        counts,
        counts[3] as usize,
    );
    let (seconds, counts) = least(|| visibility(&tree, &chains, true));
    row(
        "visibility, inherited lists",
        seconds,
        counts,
        counts[3] as usize,
    );
    let (seconds, counts) = least(|| bounds_of_patches(&chains));
    row("bounds of a patch", seconds, counts, counts[3] as usize);
    for (fewest, most) in [(1, 1), (2, 4), (5, 8), (9, 16)] {
        let cases = blocker_cases(&tree, &chains, fewest, most);
        let (seconds, counts) = least(|| blockers(&tree, &cases, most));
        row(
            &format!("blockers of {fewest} to {most}: fill and 8 segments"),
            seconds,
            counts,
            counts[3] as usize,
        );
    }
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

/// An element on the way down.
#[derive(Clone, Copy)]
enum Place {
    Node(NodeId),
    Patch([Vec3; 3], u32),
}

impl Place {
    fn of(stage: &Stage, node: NodeId) -> Self {
        match stage.hierarchy.node(node).kind {
            NodeKind::Facet => {
                let facet = stage.hierarchy.facets[stage.hierarchy.facet_of_leaf(node).index()];
                Self::Patch(stage.scene.facet_corners(facet), 0)
            }
            _ => Self::Node(node),
        }
    }

    fn bounds(self, stage: &Stage) -> ElementBounds {
        match self {
            Self::Node(node) => ElementBounds::from_box(stage.hierarchy.node(node).bounds),
            Self::Patch(corners, _) => ElementBounds::from_polygon(&corners),
        }
    }

    /// The child that `random` draws.
    fn child(self, stage: &Stage, random: u64) -> Option<Self> {
        match self {
            Self::Node(node) => {
                let children = stage.hierarchy.children(node)?;
                Some(Self::of(stage, children[(random & 1) as usize]))
            }
            Self::Patch(_, PATCH_LEVELS) => None,
            Self::Patch(corners, level) => {
                let child = split_triangle(corners, (random & 3) as u32);
                Some(Self::Patch(child, level + 1))
            }
        }
    }

    /// True for a patch that has none of `other` in front.
    fn faces_away(self, other: &ElementBounds) -> bool {
        let Self::Patch([p, q, r], _) = self else {
            return false;
        };
        let normal = (q - p).cross(r - p);
        other.corners().all(|c| normal.dot(c - p) <= 0.0)
    }
}

/// Pairs of one descent, from the first whose boxes are disjoint.
fn chain(stage: &Stage, seed: u64) -> Vec<(ElementBounds, ElementBounds)> {
    let mut random = hash_u64(seed);
    let mut places = [Place::of(stage, Hierarchy::ROOT); 2];
    let mut bounds = places.map(|p| p.bounds(stage));
    let mut pairs = Vec::new();
    loop {
        let size = |i: usize| bounds[i].aabb().surface_area();
        let larger = usize::from(size(1) > size(0));
        random = hash_u64(random);
        let next = [larger, 1 - larger]
            .into_iter()
            .find_map(|i| Some((i, places[i].child(stage, random)?)));
        let Some((i, place)) = next else { break };
        places[i] = place;
        bounds[i] = place.bounds(stage);
        let [a, b] = &bounds;
        if places[0].faces_away(b) || places[1].faces_away(a) {
            break;
        }
        if a.aabb().distance(b.aabb()) > 0.0 {
            pairs.push((*a, *b));
        }
    }
    pairs
}

fn least(run: impl Fn() -> [u64; 4]) -> (f64, [u64; 4]) {
    let mut best = f64::INFINITY;
    let mut counts = [0; 4];
    for _ in 0..REPEATS {
        let start = processor_seconds();
        for _ in 0..RUNS {
            counts = black_box(run());
        }
        best = best.min((processor_seconds() - start) / RUNS as f64);
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

fn occlusion(tree: &OccluderTree, chains: &Chains) -> [u64; 4] {
    let mut scratch = OcclusionScratch::default();
    let mut counts = [0; 4];
    for chain in chains {
        let mut last = None;
        for (a, b) in chain {
            let answer = tree.query(a, b, &mut last, &mut scratch);
            counts[0] += u64::from(answer.nodes);
            counts[1] += u64::from(answer.tests);
            counts[2] += u64::from(answer.occluder.is_some());
            counts[3] += 1;
        }
    }
    counts
}

fn visibility(tree: &SceneTree, chains: &Chains, inherit: bool) -> [u64; 4] {
    let query = VisibilityQuery::new(tree);
    let whole = SurvivorList::whole_scene(tree);
    let mut scratch = VisibilityScratch::default();
    let mut lists = [SurvivorList::new(), SurvivorList::new()];
    let mut counts = [0; 4];
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
            counts[3] += 1;
            if inherit {
                lists.swap(0, 1);
                if answer.verdict == Verdict::Visible {
                    break;
                }
            }
        }
    }
    counts
}

fn bounds_of_patches(chains: &Chains) -> [u64; 4] {
    let mut counts = [0; 4];
    for (a, _) in chains.iter().flatten() {
        let corners = [a.corner(0), a.corner(1), a.corner(2)];
        black_box(ElementBounds::from_polygon(black_box(&corners)));
        counts[3] += 1;
    }
    counts
}

/// Lists that walks leave, of `fewest` to `most` polygons, with eight segments of their pair.
fn blocker_cases(
    tree: &SceneTree,
    chains: &Chains,
    fewest: usize,
    most: usize,
) -> Vec<(SurvivorList, SegmentOctet)> {
    let query = VisibilityQuery::new(tree);
    let whole = SurvivorList::whole_scene(tree);
    let mut scratch = VisibilityScratch::default();
    let mut list = BlockerList::new(tree);
    let limits = WalkLimits {
        blocking_leaves: 8,
        ..WalkLimits::default()
    };
    let mut cases = Vec::new();
    for (a, b) in chains.iter().flatten().step_by(7) {
        let mut left = SurvivorList::new();
        query.run(a, b, &whole, &mut left, limits, &mut scratch);
        if !list.fill(tree, &left, most) || list.len() < fewest {
            continue;
        }
        let at = |bounds: &ElementBounds, lane: usize| {
            let share = (lane as f32 + 0.5) / 8.0;
            let count = bounds.corner_count();
            bounds
                .corner(lane % count)
                .lerp(bounds.corner((lane + 1) % count), share)
        };
        let (from, to) = (
            std::array::from_fn::<Vec3, 8, _>(|l| at(a, l)),
            std::array::from_fn::<Vec3, 8, _>(|l| at(b, l)),
        );
        let segments = SegmentOctet {
            from: std::array::from_fn(|axis| from.map(|p| p[axis])),
            to: std::array::from_fn(|axis| to.map(|p| p[axis])),
        };
        cases.push((left, segments));
        if cases.len() == 2_000 {
            break;
        }
    }
    cases
}

fn blockers(tree: &SceneTree, cases: &[(SurvivorList, SegmentOctet)], most: usize) -> [u64; 4] {
    let mut list = BlockerList::new(tree);
    let mut counts = [0; 4];
    // Few cases: again and again, or the clock is too coarse for them.
    for (left, segments) in cases.iter().cycle().take(BLOCKER_RUNS) {
        black_box(list.fill(tree, left, most));
        counts[1] += list.len() as u64;
        counts[2] += u64::from(list.blocked8(segments) == 255);
        counts[3] += 1;
    }
    counts
}
