//! What a sheet covers of its plane: directed edges, the surface on their left.
//!
//! Two cases. A *planar* sheet deviates at most w/4 from its plane: wherever its projection covers
//! the plane, a segment through that point passes within w of a triangle, whatever hangs together
//! with what. So overlapping, crossing and back-to-back triangles are united (`i_overlay`, filled
//! where the winding number is not zero) and only the union's contours matter. In any other sheet
//! the triangles must hang together ([`super::sheet`]), so *every* edge of the boundary is an
//! obstacle, whatever covers the plane beside it.

use super::rectangle::{Rectangle, winding};
use super::sheet::Sheet;
use super::simplify::simplify_inwards;
use super::weld::close_cracks;
use glam::DVec2;
use i_overlay::core::edge_overlay::{EdgeOverlay, InputEdge};
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay::ShapeType;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::i_float::int::point::IntPoint;

/// Grid units per normalised length for `i_overlay`. Coordinates stay below 2 (a scene fits the unit
/// cube), so numbers stay below 2^41, far within the engine's 2^62.
const GRID_SCALE: f64 = (1u64 << 40) as f64;

/// Bound on how far the contours may stray from the true ones, normalised units: 2^-30 is 1024 grid
/// units. Rounding a vertex and an intersection takes two of them; the engine's snapping of nearly
/// meeting edges doubles its squared radius with each round, of which it needs a handful, and the
/// f64 rounding of the projection (a dozen operations on numbers below 2: under 1e-14) is far less.
pub(super) const CONTOUR_ERROR: f64 = 1.0 / (1u64 << 30) as f64;

/// How far a contour may be moved inwards to lose vertices, in w. A rotated wall's contours are
/// jagged at the f32 rounding, 6e-8, which is 0.03 to 0.06 w.
const SIMPLIFY_SHARE: f64 = 0.1;

/// A sheet that deviates less than this fraction of w is planar; the strips of welded cracks stray
/// up to 0.95 w sideways, and both together must stay below w. Rounding to f32 makes 0.04.
const PLANAR_SHARE: f64 = 0.25;

/// Directed edges with the covered part of the plane on their left.
pub(super) struct Footprint {
    pub edges: Vec<[DVec2; 2]>,
    /// True where heights do not matter and the union alone decides.
    pub planar: bool,
    /// How far the covered part may stray from the polygons where cracks were closed.
    pub strip_reach: f64,
}

impl Footprint {
    /// The footprint of `sheet` in the coordinates of its frame; `weld` is w.
    pub fn new(sheet: &Sheet, weld: f64) -> Self {
        let planar = sheet.deviation <= PLANAR_SHARE * weld;
        let welded = close_cracks(&sheet.positions, &sheet.boundary, weld);
        let edges: Vec<[DVec2; 2]> = welded
            .boundary
            .iter()
            .map(|edge| edge.map(|v| sheet.positions[v as usize].truncate()))
            .collect();
        let edges = if planar {
            unite(&edges)
                .iter()
                .flat_map(|contour| closed(&simplify_inwards(contour, SIMPLIFY_SHARE * weld)))
                .collect()
        } else {
            edges
        };
        Self {
            edges,
            planar,
            strip_reach: welded.reach,
        }
    }

    /// This footprint in axes turned so that `axis` (unit) becomes the first.
    pub fn turned(&self, axis: DVec2) -> Self {
        let turn = |p: DVec2| DVec2::new(axis.dot(p), axis.perp_dot(p));
        Self {
            edges: self.edges.iter().map(|edge| edge.map(turn)).collect(),
            ..*self
        }
    }

    /// The smallest box around the edges; `None` where there are none.
    pub fn bounds(&self) -> Option<Rectangle> {
        let (first, rest) = self.edges.split_first()?;
        let around = |points: [DVec2; 2]| Rectangle {
            min: points[0].min(points[1]),
            max: points[0].max(points[1]),
        };
        Some(rest.iter().fold(around(*first), |bounds, edge| {
            let edge = around(*edge);
            Rectangle {
                min: bounds.min.min(edge.min),
                max: bounds.max.max(edge.max),
            }
        }))
    }

    /// Covered area; where a continuous sheet overlaps itself, each layer counts.
    pub fn area(&self) -> f64 {
        (0.5 * self.edges.iter().map(|[a, b]| a.perp_dot(*b)).sum::<f64>()).abs()
    }

    /// True when the rectangle's interior is certainly covered: no edge enters it, and its centre is
    /// covered. Exact on the numbers given.
    pub fn covers_rectangle(&self, rectangle: &Rectangle) -> bool {
        rectangle.min.cmplt(rectangle.max).all()
            && !self.edges.iter().any(|&edge| rectangle.is_crossed_by(edge))
            && self.covers(winding(&self.edges, rectangle.centre()))
    }

    /// True when a point with this winding number is covered.
    pub fn covers(&self, winding: i32) -> bool {
        // Moving contours inwards may leave regions of winding below 0 where a hole sticks out.
        if self.planar {
            winding > 0
        } else {
            winding != 0
        }
    }
}

/// The contours of the region where the winding number of `edges` is not zero, outer ones
/// counter-clockwise, holes clockwise. `edges` are a sum of closed curves.
fn unite(edges: &[[DVec2; 2]]) -> Vec<Vec<DVec2>> {
    let grid = |p: DVec2| {
        debug_assert!(p.is_finite());
        IntPoint::new(
            (p.x * GRID_SCALE).round() as i64,
            (p.y * GRID_SCALE).round() as i64,
        )
    };
    let mut overlay = EdgeOverlay::<i64, ()>::new(edges.len());
    overlay.options.preserve_output_collinear = false;
    for &[a, b] in edges {
        let edge = InputEdge {
            a: grid(a),
            b: grid(b),
            data: (),
        };
        overlay.add_edge(edge, ShapeType::Subject);
    }
    overlay
        .build_vector_shapes(OverlayRule::Subject, FillRule::NonZero)
        .into_iter()
        .flatten()
        .map(|contour| {
            contour
                .iter()
                .map(|edge| DVec2::new(edge.a.x as f64, edge.a.y as f64) / GRID_SCALE)
                .collect()
        })
        .collect()
}

/// The edges of a closed contour.
fn closed(contour: &[DVec2]) -> Vec<[DVec2; 2]> {
    (0..contour.len())
        .map(|i| [contour[i], contour[(i + 1) % contour.len()]])
        .collect()
}
