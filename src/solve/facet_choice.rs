//! Which facets of a cluster eight samples fall on, in proportion to what is summed over them, and which parts.

use super::patch_split::BELOW_ONE;
use std::ops::Range;

/// Where in the sums of `before` over a cluster's facets each `u` in [0,1) falls.
#[inline(always)]
fn targets(facets: &Range<usize>, before: &[f64], u: &[f32; 8]) -> [f64; 8] {
    let (start, end) = (before[facets.start], before[facets.end]);
    u.map(|u| start + f64::from(u) * (end - start))
}

/// The parts that hold the facets which `choose_facets` would choose, by the first facets of all parts but the first.
#[inline(always)]
pub(super) fn choose_parts(
    facets: &Range<usize>,
    before: &[f64],
    first_facets: &[u32],
    u: &[f32; 8],
) -> [u8; 8] {
    let target = targets(facets, before, u);
    let mut parts = [0; 8];
    for &first in first_facets {
        let before = before[first as usize];
        for l in 0..8 {
            parts[l] += u8::from(before <= target[l]);
        }
    }
    parts
}

/// Chooses facets of a cluster for the first `lanes` of eight `u` in proportion to what `before` sums, and what is left
/// of each `u` inside its facet; the other lanes mean nothing.
#[inline(always)]
pub(super) fn choose_facets(
    facets: &Range<usize>,
    before: &[f64],
    u: &[f32; 8],
    lanes: u32,
) -> ([usize; 8], [f32; 8]) {
    let sums = &before[facets.start..=facets.end];
    let target = targets(facets, before, u);
    let mut chosen = [0; 8];
    match lanes {
        1..=2 => search::<2>(sums, &target, &mut chosen),
        3..=4 => search::<4>(sums, &target, &mut chosen),
        _ => search::<8>(sums, &target, &mut chosen),
    }
    let rests = std::array::from_fn(|l| {
        let share = sums[chosen[l] + 1] - sums[chosen[l]];
        let rest = if share > 0.0 {
            ((target[l] - sums[chosen[l]]) / share) as f32
        } else {
            0.5
        };
        rest.clamp(0.0, BELOW_ONE)
    });
    (chosen.map(|place| facets.start + place), rests)
}

/// The last place in front of which no more than the target lies, by halving. The `N` searches go in step, so that they
/// wait for the memory together.
#[inline(always)]
fn search<const N: usize>(sums: &[f64], target: &[f64; 8], chosen: &mut [usize; 8]) {
    let mut candidates = sums.len() - 1;
    while candidates > 1 {
        let half = candidates / 2;
        for l in 0..N {
            let middle = chosen[l] + half;
            chosen[l] = if sums[middle] <= target[l] {
                middle
            } else {
                chosen[l]
            };
        }
        candidates -= half;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::SampleSequence;

    #[test]
    fn parts_of_a_cluster_hold_the_facets_that_are_chosen() {
        // Some facets without area, as after rounding.
        let areas = [0.5, 0.0, 1.0, 3.0, 0.25, 0.0, 0.0, 2.0, 1.0, 0.125];
        let mut before = vec![0.0_f64; 5];
        for area in areas {
            before.push(before[before.len() - 1] + area);
        }
        let range = 4..4 + areas.len();
        let first_facets = [6, 8, 9, 12];
        for index in (0..512).step_by(8) {
            let [u, ..] = SampleSequence::new(3).points(index);
            let parts = choose_parts(&range, &before, &first_facets, &u);
            for lanes in [1, 2, 3, 4, 5, 8] {
                let (facets, rests) = choose_facets(&range, &before, &u, lanes);
                for l in 0..lanes as usize {
                    let (facet, area) = (facets[l], before[facets[l] + 1] - before[facets[l]]);
                    let place = before[facet] + f64::from(rests[l]) * area;
                    let target = f64::from(u[l]) * before[before.len() - 1];
                    assert!((place - target).abs() < 1.0e-6 && area > 0.0);
                    let met = first_facets.iter().filter(|&&f| f as usize <= facet);
                    assert_eq!(usize::from(parts[l]), met.count());
                }
            }
        }
    }
}
