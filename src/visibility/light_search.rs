//! Whether the samples of an exchange carry light, where it is proved that nothing blocks them: all that is left to ask.

use super::sample_points::Surface;
use super::sampling::TRIES;
use super::trimmed::trim;
use crate::math::SampleSequence;
use pulp::{Arch, Simd, WithSimd};

/// What [`look_for_light`] found.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SampledLight {
    /// True when some sample carries light.
    pub carries: bool,
    /// True when something is left of some sample to be tested.
    pub casts: bool,
}

/// What [`super::sample_visibility`] would say with [`super::AllClear`] of elements of which nothing is hidden, at less cost: most
/// often the first sample tells.
pub fn look_for_light(
    arch: Arch,
    source: &impl Surface,
    receiver: &impl Surface,
    rays: u32,
    key: u64,
    tau: f32,
) -> SampledLight {
    arch.dispatch(LightSearch {
        source,
        receiver,
        rays,
        key,
        tau,
    })
}

/// One exchange whose samples are looked at.
struct LightSearch<'a, S, R> {
    source: &'a S,
    receiver: &'a R,
    rays: u32,
    key: u64,
    tau: f32,
}

impl<S: Surface, R: Surface> WithSimd for LightSearch<'_, S, R> {
    type Output = SampledLight;

    #[inline(always)]
    fn with_simd<I: Simd>(self, _: I) -> SampledLight {
        let sequence = SampleSequence::new(self.key);
        let mut found = SampledLight::default();
        for attempt in 0..TRIES {
            let mut index = attempt * self.rays;
            let end = index + self.rays;
            // One sample, then eight at a time.
            let mut lanes = 1;
            while index < end {
                let [u, v, s, t] = sequence.points(index);
                let (from, to) = (
                    self.source.points(&u, &v, lanes),
                    self.receiver.points(&s, &t, lanes),
                );
                let trimmed = trim(&from, &to, self.tau, lanes);
                found.carries |= trimmed.weight.iter().any(|&weight| weight > 0.0);
                found.casts |= trimmed.active != 0;
                if found.casts {
                    return found;
                }
                index += lanes;
                lanes = (end - index).min(8);
            }
            if found.carries {
                break;
            }
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::visibility::{AllClear, PartVisibility, PointOctet, sample_visibility};
    use glam::Vec3;

    /// A triangle with nothing on it.
    struct Open([Vec3; 3]);

    impl Surface for Open {
        fn points(&self, u: &[f32; 8], v: &[f32; 8], _: u32) -> PointOctet {
            let Self([a, b, c]) = *self;
            let normal = (b - a).cross(c - a).normalize();
            PointOctet::of_triangle([a, b, c], normal, u, v)
        }
    }

    #[test]
    fn looking_for_light_finds_what_clear_samples_find() {
        let sequence = SampleSequence::new(11);
        let triangle = |index: u32, size: f32| {
            Open(std::array::from_fn(|corner| {
                let [x, y, z, _] = sequence.point(3 * index + corner as u32);
                size * Vec3::new(x, y, z)
            }))
        };
        // Triangles that straddle each other's planes; where tau is large, samples that carry light cast no ray.
        let (mut dark, mut partly, mut lit) = (0, 0, 0);
        for index in 0..2000 {
            let (from, to) = (triangle(2 * index, 1.0), triangle(2 * index + 1, 0.3));
            for (rays, tau) in [(1, 1.0e-6), (3, 0.05), (8, 1.0e-6), (8, 0.3), (20, 0.05)] {
                let (arch, key) = (Arch::new(), u64::from(index));
                let clear = sample_visibility(arch, AllClear, &from, &to, rays, key, tau);
                let found = look_for_light(arch, &from, &to, rays, key, tau);
                assert_eq!(clear.all_clear, clear.visibility == PartVisibility::CLEAR);
                assert_eq!(found.carries, clear.all_clear, "{index} {rays} {tau}");
                assert_eq!(found.casts, clear.rays > 0, "{index} {rays} {tau}");
                match (found.carries, found.casts) {
                    (false, _) => dark += 1,
                    (true, false) => partly += 1,
                    (true, true) => lit += 1,
                }
            }
        }
        assert!(
            dark > 100 && partly > 100 && lit > 100,
            "{dark} {partly} {lit}"
        );
    }
}
