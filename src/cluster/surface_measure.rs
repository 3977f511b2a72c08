//! What face clustering knows of a piece of surface: its integrals, and how far from flat and from
//! compact the union of two pieces would be.
//!
//! The terms are Garland's (1999, "Quadric-Based Polygonal Surface Simplification", chapter on
//! face clusters): fit to a plane, deviation of normals, and irregularity of outline. We depart in
//! how they are combined. A weighted sum lets a small bump vanish in a large wall; here flatness
//! is measured by the *farthest* normal and comes first, by steps, then size, then outline.

use glam::DVec3;

/// Spread of normals (chord between unit vectors, about the angle in radians) below which two
/// pieces count as coplanar: 1/175 of the degree that an occluder may bend, and above what is left
/// of rounding once the tilt of narrow pieces is taken off.
const FLAT_SPREAD: f64 = 1.0e-4;

/// Rounding of a position over the diagonal of the scene. Half a unit in the last place of a
/// coordinate in [1/4, 1/2] is 2^-26; a factor of 8 covers three coordinates of three corners and
/// files written with seven digits.
const POSITION_NOISE: f64 = 8.0 / 67_108_864.0;

/// Out-of-plane root mean square over root area, times this, is about the half-angle of a fold: a
/// square folded along its middle by an angle a to both sides has a root mean square of
/// a / (2 sqrt 12).
const FIT_TO_ANGLE: f64 = 6.928_203_230_275_509;

/// Shifts the borders of logarithmic steps away from the ratios that regular meshes produce
/// (powers of two and their roots), so that rounding does not push equal pieces into unequal steps.
const STEP_SHIFT: f64 = 1.171_875;

/// Lengths that cost depends on, all proportional to the scene.
#[derive(Clone, Copy, Debug)]
pub(super) struct CostScale {
    noise: f64,
    weld: f64,
    area: f64,
}

impl CostScale {
    /// For a scene of the given diagonal, weld distance and surface area.
    pub fn new(diagonal: f64, weld: f64, area: f64) -> Self {
        Self {
            noise: POSITION_NOISE * diagonal,
            weld,
            area: area.max(f64::MIN_POSITIVE),
        }
    }
}

/// Integrals over a piece of surface, in f64, about the centre of the scene.
#[derive(Clone, Copy, Debug)]
pub(super) struct SurfaceMeasure {
    area: f64,
    area_vector: DVec3,
    /// Integral of position.
    first: DVec3,
    /// Integral of position times position: xx, yy, zz, then xy, xz, yz.
    squares: DVec3,
    products: DVec3,
    perimeter: f64,
    /// Greatest chord between a facet's unit normal and the mean one, an upper bound, less what
    /// rounding of the corners explains.
    spread: f64,
}

/// The cost of a union, for ordering only.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Cost(u32);

impl Cost {
    /// The greatest step of flatness of unions whose normals keep within `half_angle` radians.
    pub fn widest(half_angle: f64) -> u32 {
        let chord = 2.0 * (0.5 * half_angle.clamp(0.0, std::f64::consts::PI)).sin();
        1 + steps(chord / FLAT_SPREAD, 1)
    }

    /// The step of flatness, 0 for coplanar.
    pub fn flatness(self) -> u32 {
        self.0 >> 24
    }
}

impl SurfaceMeasure {
    /// Of one triangle.
    pub fn of_triangle(corners: [DVec3; 3]) -> Self {
        let [a, b, c] = corners;
        let area_vector = 0.5 * (b - a).cross(c - a);
        let area = area_vector.length();
        let sum = a + b + c;
        let products = |v: DVec3| DVec3::new(v.x * v.y, v.x * v.z, v.y * v.z);
        Self {
            area,
            area_vector,
            first: sum * (area / 3.0),
            squares: (a * a + b * b + c * c + sum * sum) * (area / 12.0),
            products: (products(a) + products(b) + products(c) + products(sum)) * (area / 12.0),
            perimeter: a.distance(b) + b.distance(c) + c.distance(a),
            spread: 0.0,
        }
    }

    pub fn area(&self) -> f64 {
        self.area
    }

    /// The union of two pieces that share `shared` of their outlines.
    pub fn union(&self, other: &Self, shared: f64, scale: &CostScale) -> Self {
        let mut union = Self {
            area: self.area + other.area,
            area_vector: self.area_vector + other.area_vector,
            first: self.first + other.first,
            squares: self.squares + other.squares,
            products: self.products + other.products,
            perimeter: (self.perimeter + other.perimeter - 2.0 * shared).max(0.0),
            spread: 0.0,
        };
        let normal = union.area_vector.normalize_or_zero();
        union.spread = self
            .spread_about(normal, scale)
            .max(other.spread_about(normal, scale))
            .min(2.0);
        union
    }

    /// Cost of becoming `union` for two pieces.
    pub fn cost(a: &Self, b: &Self, union: &Self, scale: &CostScale) -> Cost {
        let normal = union.area_vector.normalize_or_zero();
        let mean = union.first / union.area.max(f64::MIN_POSITIVE);
        let variance = (normal * normal).dot(union.squares)
            + 2.0
                * DVec3::new(
                    normal.x * normal.y,
                    normal.x * normal.z,
                    normal.y * normal.z,
                )
                .dot(union.products);
        let variance = variance / union.area.max(f64::MIN_POSITIVE) - normal.dot(mean).powi(2);
        let unfit = (variance.max(0.0).sqrt() - scale.noise).max(0.0);
        let bend = union
            .spread
            .max(FIT_TO_ANGLE * unfit / union.area.max(f64::MIN_POSITIVE).sqrt())
            .min(2.0);
        let flatness = if bend < FLAT_SPREAD {
            // Slivers have no direction to speak of, so a riser made of them would pass for flat.
            let rise = normal.dot(a.centroid() - b.centroid()).abs();
            u32::from(rise > 0.5 * scale.weld)
        } else {
            1 + steps(bend / FLAT_SPREAD, 1)
        };
        // 2^-60 of the scene's area is smaller than any triangle of distinct f32 corners matters.
        let size = steps(union.area / scale.area * 2.0_f64.powi(60), 0).min(0xff);
        let outline =
            union.perimeter * union.perimeter / (16.0 * union.area.max(f64::MIN_POSITIVE));
        let outline = steps(outline * 16.0, 3).min(0xffff);
        Cost(flatness.min(0xff) << 24 | size << 16 | outline)
    }

    fn centroid(&self) -> DVec3 {
        self.first / self.area.max(f64::MIN_POSITIVE)
    }

    /// Bound on the chord from `normal` to any facet's normal.
    fn spread_about(&self, normal: DVec3, scale: &CostScale) -> f64 {
        // The width of a piece is about 4 area / perimeter (a triangle's least altitude, a
        // square's side); rounded corners tilt it by noise over width.
        let tilt = scale.noise * self.perimeter / (4.0 * self.area.max(f64::MIN_POSITIVE));
        let chord = self.area_vector.normalize_or_zero().distance(normal);
        self.spread + (chord - tilt).max(0.0)
    }
}

/// Number of the logarithmic step, `2^log_steps` of them an octave, in which `value` lies; 0 below 1.
fn steps(value: f64, log_steps: u32) -> u32 {
    let value = value * STEP_SHIFT;
    if value <= 1.0 || value.is_nan() {
        return 0;
    }
    // The bits of a positive float grow with it: exponent, then mantissa.
    let above_one = value.to_bits() - 1.0_f64.to_bits();
    u32::try_from(above_one >> (52 - log_steps)).unwrap_or(u32::MAX)
}
