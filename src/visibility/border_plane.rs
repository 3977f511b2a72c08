//! The planes that stand on an occluder's edges, at right angles to its rectangle: where both
//! elements lie on the inner side of one, every segment between them passes inside that edge.

use super::bounds::ElementBounds;
use super::tolerance::Tolerance;
use glam::{DVec3, Vec3};

/// Unit roundoff of f32.
const U: f32 = 1.0 / 16_777_216.0;

/// The plane through an edge of both faces of a slab, along its normal.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct BorderPlane {
    /// Unit normal towards the rectangle.
    inward: DVec3,
    offset: f64,
    /// The same in f32, for the quick look.
    near: Vec3,
    near_offset: f32,
    /// Bound on the error of the quick look, over the greatest coordinate.
    doubt: f32,
}

/// How two elements, grown by [`Tolerance::nesting`], lie to a [`BorderPlane`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Lie {
    /// Proved: both wholly on the inner side.
    Inside,
    /// Both wholly on the outer side: no segment between them passes inside. (Not proved at
    /// distances below rounding: nothing is claimed from it.)
    Outside,
    /// Neither.
    Across,
}

impl BorderPlane {
    /// The plane through the edge from `start` along `direction`, which runs counter-clockwise about
    /// the slab's `normal`. It is at right angles to `direction x normal` exactly, so that the edges
    /// of both faces lie in it. An edge without length gives a plane that nothing lies inside of.
    pub(super) fn new(start: Vec3, direction: Vec3, normal: Vec3) -> Self {
        let across = normal.as_dvec3().cross(direction.as_dvec3());
        let Some(inward) = across.try_normalize() else {
            return Self {
                offset: f64::MAX,
                near_offset: f32::MAX,
                ..Self::default()
            };
        };
        let offset = inward.dot(start.as_dvec3());
        let near = inward.as_vec3();
        let near_offset = offset as f32;
        // `near` and the offset are rounded, u each; products and sums add 3 u, the difference one
        // of its two terms. With terms below `|near|_1 reach` and an offset below `sqrt(3) reach`
        // that is `(4 |near|_1 + 5.3) u reach`. Along an axis nothing is rounded but the difference,
        // and that only where it is far above the distances that are compared.
        let along_axis = near.abs().max_element() == 1.0
            && near.abs().element_sum() == 1.0
            && near.as_dvec3() == inward
            && f64::from(near_offset) == offset;
        let doubt = if along_axis {
            0.0
        } else {
            U * (4.0 * near.abs().element_sum() + 6.0)
        };
        Self {
            inward,
            offset,
            near,
            near_offset,
            doubt,
        }
    }

    /// Where the error bound of f32 leaves a doubt f64 decides: there the same terms are 1e-15.
    #[inline(always)]
    pub(super) fn lie(&self, a: &ElementBounds, b: &ElementBounds, tolerance: &Tolerance) -> Lie {
        let doubt = self.doubt * tolerance.reach;
        let grown = 1.001 * tolerance.nesting;
        let (least, greatest) = self.range(a, b);
        if least > grown + doubt {
            return Lie::Inside;
        }
        if greatest < -(grown + doubt) {
            return Lie::Outside;
        }
        if least > grown - doubt && self.least_exactly(a, b) > f64::from(grown) + 1.0e-14 {
            return Lie::Inside;
        }
        Lie::Across
    }

    #[inline(always)]
    fn range(&self, a: &ElementBounds, b: &ElementBounds) -> (f32, f32) {
        let n = self.near;
        let (mut low, mut high) = ([0.0_f32; 8], [0.0_f32; 8]);
        for l in 0..8 {
            let p = n.x * a.x[l] + n.y * a.y[l] + n.z * a.z[l];
            let q = n.x * b.x[l] + n.y * b.y[l] + n.z * b.z[l];
            (low[l], high[l]) = if p < q { (p, q) } else { (q, p) };
        }
        let (mut least, mut greatest) = (low[0], high[0]);
        for l in 1..8 {
            least = if low[l] < least { low[l] } else { least };
            greatest = if high[l] > greatest {
                high[l]
            } else {
                greatest
            };
        }
        (least - self.near_offset, greatest - self.near_offset)
    }

    #[inline(always)]
    fn least_exactly(&self, a: &ElementBounds, b: &ElementBounds) -> f64 {
        let n = self.inward;
        let mut least = [0.0_f64; 8];
        for (l, least) in least.iter_mut().enumerate() {
            let p = n.x * f64::from(a.x[l]) + n.y * f64::from(a.y[l]) + n.z * f64::from(a.z[l]);
            let q = n.x * f64::from(b.x[l]) + n.y * f64::from(b.y[l]) + n.z * f64::from(b.z[l]);
            *least = if p < q { p } else { q };
        }
        least.iter().copied().fold(f64::INFINITY, f64::min) - self.offset
    }
}
