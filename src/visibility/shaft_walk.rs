//! The walk of one shaft through the hierarchy or a list handed down (paper, section 5.1).
//!
//! It drops every box outside the shaft and every polygon that cannot block, and ends as soon as it
//! finds a box wholly inside or a polygon that may block.
//!
//! Most walks end early. A list handed down starts with what stood in the way of the pair above:
//! where that crosses the segment between the centres, no shaft is made at all; and a list of few
//! polygons goes through the slow test at once, which costs less than the planes of a shaft.

use super::crossing::{blocks_centre_segment, may_block};
use super::plane_octet::PlaneOctet;
use super::shaft::Shaft;
use super::shaft_planes::push_planes;
use super::survivors::{SurvivorEntry, SurvivorList, SurvivorOctet};
use super::verdict::Verdict;
use super::visibility_question::{Question, VisibilityAnswer};
use super::wide_corners::WideCorners;
use super::wide_tree::{BoxOctet, ChildRef};
use pulp::{Simd, WithSimd};

/// What a caller lends to queries, so that none allocates. One a task.
#[derive(Clone, Debug, Default)]
pub struct VisibilityScratch {
    stack: Vec<Pending>,
    wide: Option<[WideCorners; 2]>,
}

/// Polygons of a list up to which no shaft is made: its planes cost as much as about five slow tests.
const FEW_POLYGONS: u32 = 5;

/// Octets of a list up to which a blocked centre segment ends the walk at once: the list is handed
/// down without the sharper cut of a shaft, so it must not be long.
const SHORT_LIST: usize = 4;

/// A child still to be opened, and where its box is found.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pending {
    entry: SurvivorEntry,
    home: BoxHome,
    lane: u32,
}

#[derive(Clone, Copy, Debug)]
enum BoxHome {
    Node(u32),
    Incoming(u32),
}

/// One query in progress.
pub(super) struct Walk<'a> {
    ask: Question<'a>,
    outgoing: &'a mut SurvivorList,
    stack: &'a mut Vec<Pending>,
    /// The elements in f64, once a polygon has come up.
    wide: &'a mut Option<[WideCorners; 2]>,
    /// Depth beside a plane for [`PlaneOctet::part`].
    depth: f32,
    blocking_leaves: u32,
    answer: VisibilityAnswer,
}

/// A type, not a closure: the call of a closure is not inlined into the function that has the
/// instruction set.
impl WithSimd for Walk<'_> {
    type Output = VisibilityAnswer;

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, _: S) -> VisibilityAnswer {
        let tolerance = &self.ask.scene.tolerance;
        let mut shaft = Shaft::new(self.ask.a, self.ask.b, tolerance);
        self.outgoing.clear();
        self.stack.clear();
        *self.wide = None;
        if self.blocked_as_above() {
            self.hand_down(&shaft, 0);
            return self.answer;
        }
        if !self.has_few_polygons() {
            push_planes(&mut shaft, self.ask.a, self.ask.b, tolerance);
        }
        self.run(&shaft);
        self.answer
    }
}

impl<'a> Walk<'a> {
    /// About to start; `outgoing` will be replaced.
    pub(super) fn new(
        ask: Question<'a>,
        outgoing: &'a mut SurvivorList,
        scratch: &'a mut VisibilityScratch,
    ) -> Self {
        Self {
            ask,
            outgoing,
            stack: &mut scratch.stack,
            wide: &mut scratch.wide,
            depth: PlaneOctet::depth(&ask.scene.tolerance),
            blocking_leaves: 0,
            answer: VisibilityAnswer {
                verdict: Verdict::Unknown,
                obstacle: None,
                complete: false,
                nodes: 0,
                polygons: 0,
            },
        }
    }

    /// True if the first polygons of the list cross the segment between the centres.
    #[inline(always)]
    fn blocked_as_above(&mut self) -> bool {
        let scene = self.ask.scene;
        let octets = &self.ask.incoming.octets;
        if self.ask.limits.blocking_leaves > 1 || octets.is_empty() || octets.len() > SHORT_LIST {
            return false;
        }
        let entry = octets[0].entries[0];
        if !entry.reference().is_leaf() {
            return false;
        }
        self.answer.nodes += 1;
        let (p, q) = (
            self.ask.a.centre().as_dvec3(),
            self.ask.b.centre().as_dvec3(),
        );
        let mut lanes = entry.lanes;
        while lanes != 0 {
            let lane = lanes.trailing_zeros() as usize;
            lanes &= lanes - 1;
            let polygon = &scene.polygons[8 * entry.reference().index() + lane];
            if self.ask.faults.forgets_slivers() && is_sliver(polygon.corners) {
                continue;
            }
            if blocks_centre_segment(polygon, p, q, &scene.tolerance) {
                self.answer.obstacle = Some(polygon.id);
                return true;
            }
        }
        false
    }

    /// True if the list holds no node and so few polygons that no shaft is worth its planes.
    #[inline(always)]
    fn has_few_polygons(&self) -> bool {
        let [octet] = self.ask.incoming.octets.as_slice() else {
            return false;
        };
        let mut polygons = 0;
        for entry in &octet.entries[..self.ask.incoming.len()] {
            if !entry.reference().is_leaf() {
                return false;
            }
            polygons += entry.lanes.count_ones();
        }
        polygons <= FEW_POLYGONS
    }

    #[inline(always)]
    fn run(&mut self, shaft: &Shaft) {
        let incoming = self.ask.incoming;
        for (index, octet) in incoming.octets.iter().enumerate() {
            let met = self.open_octet(shaft, index as u32, octet);
            if !met || !self.drain(shaft) {
                self.hand_down(shaft, index + 1);
                return;
            }
        }
        self.answer.complete = true;
        if self.outgoing.is_empty() {
            self.answer.verdict = Verdict::Visible;
        }
    }

    /// Stacks the entries of an octet that meet the shaft; false if the walk is over.
    #[inline(always)]
    fn open_octet(&mut self, shaft: &Shaft, index: u32, octet: &SurvivorOctet) -> bool {
        let met = shaft.meets_boxes(&octet.boxes);
        let home = BoxHome::Incoming(index);
        self.stack_children(shaft, met, &octet.boxes, home, |lane| octet.entries[lane])
    }

    /// Stacks children so that the lowest lane is opened first; false if one lies wholly inside
    /// the shaft, which ends the walk with that one handed down first.
    #[inline(always)]
    fn stack_children(
        &mut self,
        shaft: &Shaft,
        met: u32,
        boxes: &BoxOctet,
        home: BoxHome,
        entry: impl Fn(usize) -> SurvivorEntry,
    ) -> bool {
        self.answer.nodes += 1;
        if met == 0 {
            return true;
        }
        let mut nodes = 0;
        let mut rest = met;
        while rest != 0 {
            let lane = 31 - rest.leading_zeros();
            rest &= !(1 << lane);
            let entry = entry(lane as usize);
            nodes |= u32::from(!entry.reference().is_leaf()) << lane;
            self.stack.push(Pending { entry, home, lane });
        }
        // Opening a leaf costs no more than finding it inside.
        if nodes == 0 || self.ask.limits.blocking_leaves > 1 {
            return true;
        }
        let inside = shaft.contains_boxes(boxes, nodes);
        if inside == 0 {
            return true;
        }
        let lane = inside.trailing_zeros() as usize;
        self.outgoing.push(boxes.get(lane), entry(lane));
        self.stack
            .retain(|p| !(p.lane == lane as u32 && same_home(p.home, home)));
        false
    }

    /// Opens everything on the stack; false if the walk is over.
    #[inline(always)]
    fn drain(&mut self, shaft: &Shaft) -> bool {
        let scene = self.ask.scene;
        while let Some(pending) = self.stack.pop() {
            if self.answer.nodes >= self.ask.limits.nodes {
                self.stack.push(pending);
                return false;
            }
            let reference = pending.entry.reference();
            if reference.is_leaf() {
                if !self.open_leaf(shaft, reference, pending.entry.lanes) {
                    return false;
                }
                continue;
            }
            let node = &scene.tree.nodes[reference.index()];
            let met = shaft.meets_boxes(&node.boxes);
            let home = BoxHome::Node(reference.index() as u32);
            let go_on = self.stack_children(shaft, met, &node.boxes, home, |lane| {
                let child = node.children[lane];
                let lanes = if child.is_leaf() {
                    scene.used_lanes(child.index())
                } else {
                    0
                };
                SurvivorEntry::new(child, lanes)
            });
            if !go_on {
                return false;
            }
        }
        true
    }

    /// Tests the polygons of a leaf; false if the walk is over. What may block, and what was not
    /// looked at any more, goes down.
    #[inline(always)]
    fn open_leaf(&mut self, shaft: &Shaft, leaf: ChildRef, lanes: u32) -> bool {
        let scene = self.ask.scene;
        self.answer.nodes += 1;
        let parted = scene.planes[leaf.index()].part(self.ask.a, self.ask.b, self.depth) & lanes;
        if parted == 0 {
            return true;
        }
        let mut candidates = shaft.meets_triangles(&scene.octets[leaf.index()], parted);
        if candidates == 0 {
            return true;
        }
        let (a, b) = (self.ask.a, self.ask.b);
        let wide = self
            .wide
            .get_or_insert_with(|| [WideCorners::new(a), WideCorners::new(b)]);
        let mut blocking = 0;
        let collect = self.ask.limits.blocking_leaves > 1;
        while candidates != 0 && (collect || blocking == 0) {
            let lane = candidates.trailing_zeros() as usize;
            candidates &= candidates - 1;
            let polygon = &scene.polygons[8 * leaf.index() + lane];
            self.answer.polygons += 1;
            if self.ask.faults.forgets_slivers() && is_sliver(polygon.corners) {
                continue;
            }
            let blocks = may_block(polygon, &wide[0], &wide[1], &scene.tolerance);
            if blocks {
                blocking |= 1 << lane;
                self.answer.obstacle = Some(polygon.id);
            }
        }
        let kept = blocking | candidates;
        if blocking == 0 {
            return true;
        }
        self.push_leaf(leaf, kept);
        self.blocking_leaves += 1;
        self.blocking_leaves < self.ask.limits.blocking_leaves
    }

    fn push_leaf(&mut self, leaf: ChildRef, lanes: u32) {
        let scene = self.ask.scene;
        let bounds = (0..8)
            .filter(|lane| lanes & (1 << lane) != 0)
            .map(|lane| scene.polygon_box(leaf.index(), lane))
            .reduce(crate::math::Aabb::union);
        if let Some(bounds) = bounds {
            self.outgoing.push(bounds, SurvivorEntry::new(leaf, lanes));
        }
    }

    /// After an early stop: everything not looked at goes down, or the list would not be complete.
    #[inline(always)]
    fn hand_down(&mut self, shaft: &Shaft, next_octet: usize) {
        if self.ask.faults.cuts_survivors() {
            return;
        }
        for pending in self.stack.drain(..) {
            let boxes = match pending.home {
                BoxHome::Node(node) => &self.ask.scene.tree.nodes[node as usize].boxes,
                BoxHome::Incoming(octet) => &self.ask.incoming.octets[octet as usize].boxes,
            };
            self.outgoing
                .push(boxes.get(pending.lane as usize), pending.entry);
        }
        for octet in &self.ask.incoming.octets[next_octet..] {
            let mut met = shaft.meets_boxes(&octet.boxes);
            while met != 0 {
                let lane = met.trailing_zeros() as usize;
                met &= met - 1;
                self.outgoing
                    .push(octet.boxes.get(lane), octet.entries[lane]);
            }
        }
    }
}

fn same_home(a: BoxHome, b: BoxHome) -> bool {
    match (a, b) {
        (BoxHome::Node(a), BoxHome::Node(b)) | (BoxHome::Incoming(a), BoxHome::Incoming(b)) => {
            a == b
        }
        _ => false,
    }
}

/// For the planted fault only: more than twenty times longer than wide.
fn is_sliver(corners: [glam::Vec3; 3]) -> bool {
    let [a, b, c] = corners;
    let longest = (b - a)
        .length_squared()
        .max((c - b).length_squared())
        .max((a - c).length_squared());
    (b - a).cross(c - a).length() < longest / 20.0
}
