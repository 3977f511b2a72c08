//! Points of the real surfaces of elements: uniform by area, or on the borders of their triangles.

use super::dice::Dice;
use crate::cluster::Hierarchy;
use crate::scene::Scene;
use crate::solve::{Element, Shape};
use glam::{DVec3, Vec3};

/// A point of a triangle, with the triangle's unit normal.
#[derive(Clone, Copy, Debug)]
pub(super) struct ElementPoint {
    pub position: Vec3,
    pub normal: Vec3,
}

/// Where on a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    Inside,
    Edge,
    Corner,
}

/// Draws points of any element of a scene.
pub(super) struct ElementPoints<'a> {
    scene: &'a Scene,
    hierarchy: &'a Hierarchy,
    /// Sum of the facets' areas before each facet, and of all at the end.
    area_before: Vec<f64>,
}

impl<'a> ElementPoints<'a> {
    pub fn new(scene: &'a Scene, hierarchy: &'a Hierarchy) -> Self {
        let mut area_before = vec![0.0];
        let mut sum = 0.0;
        for facet in &hierarchy.facets {
            sum += scene.polygon_area(facet.polygon);
            area_before.push(sum);
        }
        Self {
            scene,
            hierarchy,
            area_before,
        }
    }

    /// A point of `element`: of a patch itself, of a cluster on one of its facets, chosen by area.
    pub fn draw(&self, element: &Element, place: Place, dice: &mut Dice) -> ElementPoint {
        let (corners, normal) = self.triangle(element, dice);
        ElementPoint {
            position: point_of(corners, place, dice),
            normal,
        }
    }

    /// Where the line from `from` through `x` and beyond meets a triangle of `element` (for a cluster
    /// one of its facets, chosen by area), if it does.
    pub fn draw_behind(
        &self,
        element: &Element,
        from: Vec3,
        x: DVec3,
        dice: &mut Dice,
    ) -> Option<ElementPoint> {
        let (corners, normal) = self.triangle(element, dice);
        let [a, b, c] = corners.map(Vec3::as_dvec3);
        let (start, along) = (from.as_dvec3(), x - from.as_dvec3());
        let plane = (b - a).cross(c - a);
        let t = plane.dot(a - start) / plane.dot(along);
        let hit = start + along * t;
        let inside = [(a, b), (b, c), (c, a)]
            .into_iter()
            .all(|(v, w)| plane.dot((w - v).cross(hit - v)) >= 0.0);
        // Not so where `t` is NaN.
        (t > 1.0 && inside).then_some(ElementPoint {
            position: hit.as_vec3(),
            normal,
        })
    }

    /// The corners and unit normal of a patch, or of a facet of a cluster.
    fn triangle(&self, element: &Element, dice: &mut Dice) -> ([Vec3; 3], Vec3) {
        match element.shape {
            Shape::Triangle(corners) => (corners, element.normal),
            _ => {
                let facet = self.hierarchy.facets[self.choose(element, dice)];
                let corners = self.scene.facet_corners(facet);
                let [a, b, c] = corners.map(Vec3::as_dvec3);
                let normal = (b - a).cross(c - a).normalize_or_zero().as_vec3();
                (corners, normal)
            }
        }
    }

    fn choose(&self, element: &Element, dice: &mut Dice) -> usize {
        let first = element.first_facet as usize;
        let sums = &self.area_before[first..=first + element.facet_count as usize];
        let target = sums[0] + f64::from(dice.unit()) * (sums[sums.len() - 1] - sums[0]);
        first + sums[1..sums.len() - 1].partition_point(|&x| x <= target)
    }
}

/// A point of a triangle, uniform over its area, its border or its corners.
pub(super) fn point_of([a, b, c]: [Vec3; 3], place: Place, dice: &mut Dice) -> Vec3 {
    match place {
        Place::Inside => {
            let [mut u, mut v] = dice.pair();
            if u + v > 1.0 {
                (u, v) = (1.0 - u, 1.0 - v);
            }
            a + (b - a) * u + (c - a) * v
        }
        Place::Edge => {
            let (from, to) = [(a, b), (b, c), (c, a)][dice.below(3)];
            from + (to - from) * dice.unit()
        }
        Place::Corner => [a, b, c][dice.below(3)],
    }
}
