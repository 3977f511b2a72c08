//! A small scene on which claims of visibility are asked for and judged in exact arithmetic.

use super::exact::{PolygonStanding, judge_polygon};
use super::nasty_pairs::Draw;
use super::nasty_scenes::Triangles;
use super::{
    ElementBounds, SceneTree, SurvivorList, Tolerance, Verdict, VisibilityAnswer, VisibilityQuery,
    VisibilityScratch, WalkLimits,
};
use crate::math::Aabb;

/// Triangles, and the hierarchy over them.
pub(super) struct Stage {
    pub(super) triangles: Triangles,
    pub(super) tree: SceneTree,
}

impl Stage {
    pub(super) fn new(triangles: Triangles) -> Self {
        let bounds = Aabb::from_points(triangles.iter().flatten().copied());
        let tree = SceneTree::over_triangles(&triangles, Tolerance::of_scene(bounds));
        Self { triangles, tree }
    }

    pub(super) fn ask(&self, a: &ElementBounds, b: &ElementBounds) -> VisibilityAnswer {
        let whole = SurvivorList::whole_scene(&self.tree);
        self.ask_with(a, b, &whole).0
    }

    pub(super) fn ask_with(
        &self,
        a: &ElementBounds,
        b: &ElementBounds,
        incoming: &SurvivorList,
    ) -> (VisibilityAnswer, SurvivorList) {
        let (answer, outgoing) = self.walk(a, b, incoming, WalkLimits::default());
        assert_eq!(answer.verdict == Verdict::Visible, outgoing.is_empty());
        (answer, outgoing)
    }

    /// The answer of a walk within `limits`, and what it hands down.
    pub(super) fn walk(
        &self,
        a: &ElementBounds,
        b: &ElementBounds,
        incoming: &SurvivorList,
        limits: WalkLimits,
    ) -> (VisibilityAnswer, SurvivorList) {
        let mut outgoing = SurvivorList::new();
        let answer = VisibilityQuery::new(&self.tree).run(
            a,
            b,
            incoming,
            &mut outgoing,
            limits,
            &mut VisibilityScratch::default(),
        );
        (answer, outgoing)
    }

    /// The polygons that refute visibility, and whether every polygon is proved out of the way.
    pub(super) fn judge(&self, a: &ElementBounds, b: &ElementBounds) -> (Vec<u32>, bool) {
        let (mut blockers, mut proved) = (Vec::new(), true);
        for (triangle, i) in self.triangles.iter().zip(0..) {
            match judge_polygon(a, b, *triangle, self.tree.tolerance()) {
                PolygonStanding::Blocks(..) => blockers.push(i),
                PolygonStanding::NotRefuted => proved = false,
                PolygonStanding::Outside | PolygonStanding::Harmless => {}
            }
        }
        (blockers, proved)
    }

    pub(super) fn triangle(&self, i: u32) -> ElementBounds {
        ElementBounds::from_polygon(&self.triangles[i as usize])
    }

    /// A patch: a triangle of the scene, split a few times as the solver splits.
    pub(super) fn patch(&self, draw: &mut Draw) -> ElementBounds {
        let mut corners = self.triangles[draw.below(self.triangles.len() as u32) as usize];
        for _ in 0..draw.below(5) {
            let [a, b, c] = corners;
            let (ab, bc, ca) = ((a + b) * 0.5, (b + c) * 0.5, (c + a) * 0.5);
            corners = [[a, ab, ca], [ab, b, bc], [ca, bc, c], [bc, ca, ab]][draw.below(4) as usize];
        }
        ElementBounds::from_polygon(&corners)
    }

    /// A patch, or the box of a few triangles that follow each other.
    pub(super) fn element(&self, draw: &mut Draw) -> ElementBounds {
        if draw.below(3) != 0 {
            return self.patch(draw);
        }
        let first = draw.below(self.triangles.len() as u32) as usize;
        let last = (first + draw.below(8) as usize).min(self.triangles.len() - 1);
        ElementBounds::from_box(Aabb::from_points(
            self.triangles[first..=last].iter().flatten().copied(),
        ))
    }
}
