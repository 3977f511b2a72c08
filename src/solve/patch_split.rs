//! How a patch's light is spread over its four children: where samples go, and when a patch is too unevenly lit
//! to shoot as one.

/// A patch of a shooter: its children and their shares of its light.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(32))]
pub struct PatchSplit {
    /// Index of the first of four children; 0 for a leaf (0 is a facet, never a child).
    pub first: u32,
    /// Shares of the light, all channels together, that the first, the first two and the first three children hold.
    pub before: [f32; 3],
    /// Relative variance of the radiosity over the patch: the mean of its square over the square of its mean, less 1.
    pub variance: f32,
}

impl PatchSplit {
    /// A patch with children from `first` on, of equal areas, with these radiosities and relative variances.
    pub fn new<const C: usize>(first: u32, radiosity: [[f32; C]; 4], variance: [f32; 4]) -> Self {
        let light = radiosity.map(|b| b.iter().sum::<f32>());
        let total: f32 = light.iter().sum();
        if total <= 0.0 {
            // Nothing is shot: any shares serve.
            return Self {
                first,
                before: [0.25, 0.5, 0.75],
                variance: 0.0,
            };
        }
        Self {
            first,
            before: [
                light[0] / total,
                (light[0] + light[1]) / total,
                (light[0] + light[1] + light[2]) / total,
            ],
            variance: relative_variance([0.25; 4], light, variance),
        }
    }

    /// True for a leaf, and for a patch lit so evenly that a uniform sample of it serves.
    #[inline(always)]
    pub fn is_even(&self) -> bool {
        self.first == 0 || self.variance < EVEN_VARIANCE
    }

    /// The child that holds the share `u` in [0,1) of the light, and where in it.
    #[inline(always)]
    pub fn choose(&self, u: f32) -> (u32, f32) {
        let [a, b, c] = self.before;
        let which = u32::from(u >= a) + u32::from(u >= b) + u32::from(u >= c);
        let (low, high) = match which {
            0 => (0.0, a),
            1 => (a, b),
            2 => (b, c),
            _ => (c, 1.0),
        };
        let rest = (u - low) / (high - low).max(f32::MIN_POSITIVE);
        (which, rest.clamp(0.0, BELOW_ONE))
    }
}

/// Relative variance up to which a patch counts as evenly lit: a standard deviation of a tenth, in what only weighs
/// the samples of one visibility.
const EVEN_VARIANCE: f32 = 0.01;

/// The greatest f32 below 1.
pub const BELOW_ONE: f32 = 1.0 - f32::EPSILON / 2.0;

/// Relative variance of a whole of which each part has a share of the area, a mean and a relative variance.
pub fn relative_variance<const N: usize>(
    area: [f32; N],
    mean: [f32; N],
    variance: [f32; N],
) -> f32 {
    let (mut first, mut second) = (0.0_f64, 0.0_f64);
    for k in 0..N {
        let (area, mean) = (f64::from(area[k]), f64::from(mean[k]));
        first += area * mean;
        second += area * mean * mean * (1.0 + f64::from(variance[k]));
    }
    if first > 0.0 {
        (second / (first * first) - 1.0).max(0.0) as f32
    } else {
        0.0
    }
}

/// Eight points of a frozen patch that is lit unevenly: down its split with `u`, by the children's light. In coordinates
/// along the first two edges from the patch's first corner.
#[inline(always)]
pub(super) fn lit_points(
    splits: &[PatchSplit],
    slot: u32,
    u: &[f32; 8],
    v: &[f32; 8],
) -> [[f32; 8]; 2] {
    let mut places = u.map(Place::of_patch);
    let mut patches = [slot; 8];
    // The first step is from the same patch for all.
    for l in 0..8 {
        patches[l] = places[l].descend(&splits[slot as usize]);
    }
    for l in 0..8 {
        while !splits[patches[l] as usize].is_even() {
            patches[l] = places[l].descend(&splits[patches[l] as usize]);
        }
    }
    let mut points = [[0.0; 8]; 2];
    for l in 0..8 {
        [points[0][l], points[1][l]] = places[l].point(v[l]);
    }
    points
}

/// One such point of a patch of any light.
#[inline(always)]
pub(super) fn lit_point(splits: &[PatchSplit], mut patch: u32, [u, v]: [f32; 2]) -> [f32; 2] {
    let mut place = Place::of_patch(u);
    while !splits[patch as usize].is_even() {
        patch = place.descend(&splits[patch as usize]);
    }
    place.point(v)
}

/// Where on the way down a patch's split a point is. Every child has the patch's edges, halved, the middle one turned
/// about.
#[derive(Clone, Copy)]
struct Place {
    along: f32,
    across: f32,
    scale: f32,
    /// What is left of the choice.
    u: f32,
}

impl Place {
    #[inline(always)]
    fn of_patch(u: f32) -> Self {
        Self {
            along: 0.0,
            across: 0.0,
            scale: 1.0,
            u,
        }
    }

    /// One step down: the child of `split` that holds the share `u` of its light.
    #[inline(always)]
    fn descend(&mut self, split: &PatchSplit) -> u32 {
        let (which, rest) = split.choose(self.u);
        self.u = rest;
        let half = 0.5 * self.scale;
        self.along += if which & 1 == 1 { half } else { 0.0 };
        self.across += if which & 2 == 2 { half } else { 0.0 };
        self.scale = if which == 3 { -half } else { half };
        split.first + which
    }

    #[inline(always)]
    fn point(&self, v: f32) -> [f32; 2] {
        let [u, v] = folded([self.u, v]);
        [self.along + self.scale * u, self.across + self.scale * v]
    }
}

/// A point of the unit square, folded along its diagonal.
#[inline(always)]
pub(super) fn folded([u, v]: [f32; 2]) -> [f32; 2] {
    match u + v > 1.0 {
        true => [1.0 - u, 1.0 - v],
        false => [u, v],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_go_where_the_light_is() {
        let split = PatchSplit::new(4, [[1.0], [0.0], [2.0], [5.0]], [0.0; 4]);
        let mut counts = [0; 4];
        for i in 0..8000 {
            let u = (i as f32 + 0.5) / 8000.0;
            let (which, rest) = split.choose(u);
            assert!((0.0..1.0).contains(&rest));
            counts[which as usize] += 1;
        }
        assert_eq!(counts, [1000, 0, 2000, 5000]);
        // Within a child the points are spread evenly.
        assert_eq!(split.choose(0.0625), (0, 0.5));
        assert_eq!(split.choose(BELOW_ONE).0, 3);
    }

    #[test]
    fn variance_is_that_of_all_leaves_however_they_are_nested() {
        let inner = PatchSplit::new(8, [[1.0], [2.0], [3.0], [6.0]], [0.0; 4]);
        let outer = PatchSplit::new(
            4,
            [[3.0], [0.0], [4.0], [8.0]],
            [inner.variance, 0.0, 0.0, 0.0],
        );
        let leaves: [(f32, f32); 7] = [
            (0.0625, 1.0),
            (0.0625, 2.0),
            (0.0625, 3.0),
            (0.0625, 6.0),
            (0.25, 0.0),
            (0.25, 4.0),
            (0.25, 8.0),
        ];
        let mean: f32 = leaves.iter().map(|(a, b)| a * b).sum();
        let square: f32 = leaves.iter().map(|(a, b)| a * b * b).sum();
        assert!((outer.variance - (square / (mean * mean) - 1.0)).abs() < 1e-6);
        assert_eq!(
            PatchSplit::new(4, [[0.0]; 4], [0.0; 4]).variance,
            0.0,
            "dark"
        );
    }
}
