//! Proofs by test that a screen blocks only what its rectangle blocks in exact arithmetic, and most of that.

use super::exact::replay_occlusion;
use super::nasty_pairs::Draw;
use super::near_segments::SegmentOctet;
use super::sampling::SampleOctet;
use super::screen::Screen;
use super::{ElementBounds, Tolerance};
use crate::math::Aabb;
use crate::occluder::SlabRectangle;
use glam::Vec3;
use proptest::prelude::*;

/// A rectangle and eight segments that cross its plane within or near it, their ends close to it at times.
struct Case {
    slab: SlabRectangle,
    segments: [[Vec3; 2]; 8],
    tolerance: Tolerance,
}

impl Case {
    fn draw(draw: &mut Draw) -> Self {
        let turn = draw.rotation();
        let (u, v, n) = (turn * Vec3::X, turn * Vec3::Y, turn * Vec3::Z);
        let centre = draw.point() * 0.2;
        // Hairlines among them: a thousandth of a thousandth as wide as long.
        let (hu, hv) = (draw.scale(1.0e-5, 0.3), draw.scale(1.0e-5, 0.3));
        let half_thickness = [1.0e-6, 2.0e-6, 1.0e-4, 0.01][draw.below(4) as usize];
        let slab = SlabRectangle::new(centre, u * hu, v * hv, n, half_thickness);
        let segments = std::array::from_fn(|_| {
            let place = |draw: &mut Draw, half: f32| match draw.below(3) {
                0 => half * draw.between(-1.1, 1.1),
                1 => half - draw.scale(1.0e-8, 1.0e-3),
                _ => draw.scale(1.0e-8, 1.0e-3) - half,
            };
            let crossing = centre + u * place(draw, hu) + v * place(draw, hv);
            let way = (n * draw.scale(1.0e-4, 1.0) + draw.point()).normalize_or(n);
            let (before, behind) = (draw.scale(1.0e-6, 0.2), draw.scale(1.0e-6, 0.2));
            let ends = [crossing - way * before, crossing + way * behind];
            if draw.below(2) == 0 {
                ends
            } else {
                [ends[1], ends[0]]
            }
        });
        let everything = Aabb {
            min: Vec3::splat(-0.5),
            max: Vec3::splat(0.5),
        };
        Self {
            slab,
            segments,
            tolerance: Tolerance::of_scene(everything),
        }
    }

    fn octet(&self, near: f32, far: f32) -> SampleOctet {
        let ends = |end: usize| {
            std::array::from_fn(|axis| self.segments.map(|segment| segment[end][axis]))
        };
        SampleOctet {
            segments: SegmentOctet {
                from: ends(0),
                to: ends(1),
            },
            near: [near; 8],
            far: [far; 8],
        }
    }

    fn blocked(&self, near: f32, far: f32) -> u8 {
        Screen::new(&self.slab, &self.tolerance).blocks(&self.octet(near, far))
    }

    /// Whether exact arithmetic proves that a rectangle blocks a segment.
    fn is_proved(&self, slab: &SlabRectangle, lane: usize) -> bool {
        let [p, q] = self.segments[lane].map(|p| ElementBounds::from_polygon(&[p, p, p]));
        replay_occlusion(slab, &p, &q, &self.tolerance).is_ok()
    }

    /// Whether the segment is neither flat nor near the border: a smaller rectangle in a thicker slab blocks it too.
    fn is_clear_case(&self, lane: usize) -> bool {
        const MARGIN: f32 = 1.0e-4;
        let [a, b, c, d] = self.slab.corners;
        let (u, v) = ((b - a) * 0.5, (d - a) * 0.5);
        let shrunk = |half: Vec3| half.normalize() * (half.length() - MARGIN);
        if u.length() < 2.0 * MARGIN || v.length() < 2.0 * MARGIN {
            return false;
        }
        let within = SlabRectangle::new(
            (a + c) * 0.5,
            shrunk(u),
            shrunk(v),
            self.slab.normal,
            self.slab.half_thickness + 1.0e-5,
        );
        let [p, q] = self.segments[lane];
        let steepness = (q - p).normalize_or_zero().dot(self.slab.normal).abs();
        steepness > 0.1 && self.is_proved(&within, lane)
    }
}

#[test]
fn nothing_is_blocked_that_passes_the_rectangle_in_exact_arithmetic_and_clear_cases_are() {
    let (mut clear, mut blocked) = (0, 0);
    for seed in 0..20_000 {
        let case = Case::draw(&mut Draw::new(seed));
        let mask = case.blocked(0.0, 1.0);
        for lane in 0..8 {
            if mask & (1 << lane) != 0 {
                blocked += 1;
                assert!(
                    case.is_proved(&case.slab, lane),
                    "case {seed}, segment {lane}"
                );
            } else {
                assert!(!case.is_clear_case(lane), "case {seed}, segment {lane}");
            }
            clear += u32::from(case.is_clear_case(lane));
        }
    }
    println!("{blocked} blocked, {clear} clear among 160000 segments");
    assert!(clear > 3_000 && blocked > clear, "{clear} of {blocked}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4_000))]

    #[test]
    fn nothing_is_blocked_falsely_for_any_seed(seed in any::<u64>()) {
        let case = Case::draw(&mut Draw::new(seed));
        let mask = case.blocked(0.0, 1.0);
        for lane in (0..8).filter(|lane| mask & (1 << lane) != 0) {
            prop_assert!(case.is_proved(&case.slab, lane));
        }
    }

    /// A segment cut back to one side of the slab is not blocked: Embree does not see what lies beyond its ends.
    #[test]
    fn what_is_cut_off_does_not_count(seed in any::<u64>(), part in 0.0..1.0_f32) {
        let case = Case::draw(&mut Draw::new(seed));
        let (first, second) = (case.blocked(0.0, part), case.blocked(part, 1.0));
        prop_assert_eq!(first & second, 0);
        prop_assert_eq!((first | second) & !case.blocked(0.0, 1.0), 0);
    }
}

#[test]
fn clear_cases() {
    let slab = SlabRectangle::new(Vec3::ZERO, Vec3::X * 0.3, Vec3::Y * 0.1, Vec3::Z, 1.0e-3);
    let tolerance = Tolerance::of_scene(Aabb {
        min: Vec3::splat(-0.5),
        max: Vec3::splat(0.5),
    });
    let up = |x: f32, y: f32| [Vec3::new(x, y, -0.2), Vec3::new(x, y, 0.3)];
    let case = Case {
        slab,
        segments: [
            up(0.0, 0.0),
            up(0.299, -0.099),
            up(0.301, 0.0),
            up(0.0, -0.101),
            // Both on one side; along the plane; an end within the slab; a segment without length.
            [Vec3::new(0.0, 0.0, 0.1), Vec3::new(0.0, 0.0, 0.2)],
            [Vec3::new(-0.4, 0.0, 0.0), Vec3::new(0.4, 0.0, 0.0)],
            [Vec3::new(0.0, 0.0, 5.0e-4), Vec3::new(0.0, 0.0, -0.2)],
            [Vec3::ZERO; 2],
        ],
        tolerance,
    };
    assert_eq!(case.blocked(0.0, 1.0), 0b0000_0011);
    // The crossing lies at two fifths.
    assert_eq!(case.blocked(0.0, 0.39), 0);
    assert_eq!(case.blocked(0.41, 1.0), 0);
    assert_eq!(case.blocked(0.39, 0.41), 0b0000_0011);
}
