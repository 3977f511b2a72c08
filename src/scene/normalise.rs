//! The map from the file's units to the unit cube, in f64 (see `model.rs`).

use super::file_box::{FileBox, centre_and_span};
use super::model::Normalisation;
use glam::{DMat3, DVec3};

/// A span that exceeds a power of two by less than this share still counts as that power: a scene
/// moved far off is rounded by about 1e-10 of its size and must not jump to the next scale. What
/// overhangs the unit cube then is 2^-31, less than half a step of f32 there.
const SNAP: f64 = 1.0 / (1u64 << 30) as f64;

/// The normalisation that turns `positions`, which `file` bounds, by the rotation `turn`, and fits them into the unit cube
/// around the origin.
///
/// Scaling all positions by a power of two scales the centre and inverts the scale exactly, so
/// that normalised positions keep their bits.
pub(super) fn normalisation_of(positions: &[DVec3], file: FileBox, turn: DMat3) -> Normalisation {
    // About the centre as read: where that is far off, little is left of the digits that a rotation about the origin needs.
    let (centre, span) = centre_and_span(positions.iter().map(|&p| turn * (p - file.centre)));
    Normalisation {
        centre: file.centre + turn.transpose() * centre,
        scale: 1.0 / power_of_two_above(span),
        turn,
    }
}

/// The least power of two that is at least `span * (1 - SNAP)`; `span` is normal and positive.
fn power_of_two_above(span: f64) -> f64 {
    const EXPONENT: u64 = 0x7ff0_0000_0000_0000;
    let below = f64::from_bits(span.to_bits() & EXPONENT);
    if span <= below * (1.0 + SNAP) {
        below
    } else {
        below * 2.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn fitted(positions: &[DVec3]) -> Normalisation {
        normalisation_of(
            positions,
            FileBox::around(positions).unwrap(),
            DMat3::IDENTITY,
        )
    }

    fn normalised(positions: &[DVec3]) -> Vec<glam::Vec3> {
        let map = fitted(positions);
        positions.iter().map(|&p| map.to_normalised(p)).collect()
    }

    fn points() -> impl Strategy<Value = Vec<DVec3>> {
        prop::collection::vec(
            (-10.0..10.0f64, -3.0..9.0f64, 2.0..3.0f64).prop_map(DVec3::from),
            2..20,
        )
    }

    proptest! {
        #[test]
        fn fits_the_unit_cube_and_fills_half_of_it(points in points()) {
            let inside = normalised(&points);
            let size = crate::math::Aabb::from_points(inside.iter().copied());
            prop_assert!(inside.iter().all(|p| p.abs().max_element() <= 0.5));
            prop_assert!((size.max - size.min).max_element() > 0.4999);
        }

        #[test]
        fn scaling_by_a_power_of_two_keeps_every_bit(points in points(), exponent in -190..190i32) {
            let factor = 2f64.powi(exponent);
            let scaled: Vec<_> = points.iter().map(|p| p * factor).collect();
            prop_assert_eq!(normalised(&points), normalised(&scaled));
        }

        #[test]
        fn moving_by_a_representable_step_keeps_every_bit(
            points in prop::collection::vec(prop::array::uniform3(-1000..1000i32), 2..20),
            step in prop::array::uniform3(-1_000_000..1_000_000i32),
        ) {
            // Multiples of 1/64 stay exact when moved by whole units.
            let at = |p: &[i32; 3]| DVec3::from(p.map(|c| f64::from(c) / 64.0));
            let here: Vec<_> = points.iter().map(at).collect();
            prop_assume!(here.iter().any(|p| p != &here[0]));
            let there: Vec<_> = here.iter().map(|p| p + DVec3::from(step.map(f64::from))).collect();
            prop_assert_eq!(normalised(&here), normalised(&there));
        }

        #[test]
        fn moving_far_off_changes_less_than_rounding(points in points(), step in -1e6..1e6f64) {
            let there: Vec<_> = points.iter().map(|p| p + DVec3::splat(step)).collect();
            // f64 keeps 2^-33 of a unit at that distance, in the points and in the centre; f32
            // then rounds to 2^-25.
            let tolerance =
                2f64.powi(-25) + 4.0 * 2f64.powi(-33) * fitted(&points).scale;
            for (a, b) in normalised(&points).into_iter().zip(normalised(&there)) {
                prop_assert!(f64::from((a - b).abs().max_element()) <= tolerance);
            }
        }
    }

    #[test]
    fn a_span_just_above_a_power_of_two_does_not_jump() {
        let cube = |side: f64| [DVec3::ZERO, DVec3::splat(side)];
        assert_eq!(fitted(&cube(4.0)).scale, 0.25);
        assert_eq!(fitted(&cube(4.0 + 1e-9)).scale, 0.25);
        assert_eq!(fitted(&cube(4.1)).scale, 0.125);
        assert!(
            normalised(&cube(4.0 + 1e-9))
                .iter()
                .all(|p| p.abs().max_element() <= 0.5)
        );
    }
}
