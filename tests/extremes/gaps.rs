//! Gaps between a wall and the floor that it stands on.

use crate::agreement::{coarse, faces, hold, prepare, solve_by};
use crate::mesh::{DARK_ROOM, two_rooms};
use certilux::scene::Side;
use certilux::solve::{Stop, Technique};
use glam::DVec3;
use std::f64::consts::PI;

/// Gaps over the scene's diagonal. Up to the weld distance of 1e-6 a gap counts as closed.
const GAPS: [f64; 7] = [0.0, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2];

/// A gap of this many weld distances is open beyond doubt.
const WELD: f64 = 1.0e-6;

#[test]
fn a_gap_lets_through_no_more_than_it_is_wide() {
    let diagonal = 12f64.sqrt();
    let mut dark_before = 0.0;
    for gap in GAPS {
        let height = gap * diagonal;
        let room = two_rooms().sheet(
            "wall",
            [
                DVec3::new(-1.0, -1.0 + height, 0.0),
                DVec3::new(2.0, 0.0, 0.0),
                DVec3::new(0.0, 2.0 - height, 0.0),
            ],
            [3, 3],
        );
        let prepared = prepare(&room);
        let claims = hold(&format!("a gap of {gap:e}"), &prepared, &coarse());
        assert!(
            claims.occluded > 0,
            "the wall hides the lamp from most of the other room"
        );
        let mut config = coarse();
        config.stop = Stop::Passes(4);
        let solved = solve_by(&prepared, Technique::Occlusion, &config);
        let found = faces(&prepared, &solved);
        let received = |f: u32| {
            found
                .get(&(f, Side::Front))
                .map_or(0.0, |f| f.irradiance[0])
        };
        let dark = prepared
            .scene
            .normalisation
            .area_to_file(DARK_ROOM.map(received).sum());
        // What reaches the slot is less than the radiosity of the brightest surface, the lamp, over its area.
        let most = 10.0 * PI * 2.0 * height;
        println!(
            "a gap of {gap:e}: {dark:.3e} W reach the wall behind, at most {most:.3e} can; {:?}",
            solved.power.imbalance
        );
        if gap <= WELD {
            assert_eq!(dark, 0.0, "a gap of {gap:e} counts as closed");
        }
        assert!(dark <= most, "a gap of {gap:e}");
        assert!(dark >= dark_before);
        dark_before = dark;
    }
    assert!(dark_before > 0.0, "an open gap lets light through");
}
