//! A solve that goes on from any of its states ends as if it had never stopped; anything else is refused whole.

use super::config::{Normalise, SolveConfig, Stop, Technique};
use super::fixture::{add_box, grey, prepare, scene};
use super::observer::{Observer, Silent};
use super::prepared::PreparedScene;
use super::snapshot::Snapshot;
use super::solve::{Solved, resume, solve};
use super::{PassStatistics, SolveError};
use crate::occluder::OccluderConfig;
use crate::scene::{Scene, Surface};
use glam::Vec3;
use std::sync::Mutex;

/// Keeps every state that it hears of.
#[derive(Default)]
struct Album(Mutex<Vec<Snapshot>>);

impl Observer for Album {
    fn state_reached(&self, take: &dyn Fn() -> Snapshot) {
        self.0.lock().unwrap().push(take());
    }
}

fn room(surface: Surface) -> Scene {
    let mut s = scene(vec![surface, grey(0.3, 0.0)]);
    add_box(
        &mut s,
        Vec3::splat(-0.5),
        Vec3::splat(0.5),
        2,
        [0, 1, 0, 1, 1, 1],
        true,
    );
    let (lo, hi) = (Vec3::new(-0.2, -0.3, -0.4), Vec3::new(0.1, 0.2, 0.1));
    add_box(&mut s, lo, hi, 1, [1; 6], false);
    s
}

fn coloured() -> Surface {
    Surface {
        material: "red".to_owned(),
        reflectance: [0.8, 0.3, 0.1],
        emission: [2.0, 1.0, 0.5],
    }
}

fn config(technique: Technique) -> SolveConfig {
    SolveConfig {
        technique,
        epsilon: 5.0e-4,
        gradient: 0.01,
        stop: Stop::Passes(3),
        normalise: Normalise::On,
        ..SolveConfig::default()
    }
}

fn prepared(surface: Surface) -> PreparedScene {
    prepare(&room(surface)).with_guarantees(Technique::Blockers, &OccluderConfig::default())
}

/// All of a result but the clocks.
fn without_clocks(mut solved: Solved) -> String {
    for pass in &mut solved.passes {
        pass.seconds = 0.0;
    }
    format!("{solved:?}")
}

#[test]
fn going_on_from_any_state_gives_the_same_bits() {
    let techniques = [Technique::Normal, Technique::Occlusion, Technique::Blockers];
    for surface in [grey(0.7, 1.0), coloured()] {
        let prepared = prepared(surface);
        for config in techniques.map(config) {
            let album = Album::default();
            let whole = without_clocks(solve(&prepared, &config, &album).unwrap());
            let states = album.0.into_inner().unwrap();
            assert_eq!(states.len(), 3);
            for state in &states {
                let state = Snapshot::from_bytes(state.as_bytes().to_vec());
                let resumed = resume(&prepared, &config, &Silent, &state).unwrap();
                assert!(whole == without_clocks(resumed), "{:?}", config.technique);
            }
        }
    }
}

#[test]
fn the_last_state_needs_no_further_pass() {
    struct NoPass;
    impl Observer for NoPass {
        fn pass_started(&self, pass: u32, _: usize) {
            panic!("pass {pass}");
        }
    }
    let prepared = prepared(coloured());
    let config = SolveConfig {
        stop: Stop::Converged(0.05),
        ..config(Technique::Normal)
    };
    let album = Album::default();
    let whole = solve(&prepared, &config, &album).unwrap();
    assert!(whole.passes.len() > 1);
    let states = album.0.into_inner().unwrap();
    let resumed = resume(&prepared, &config, &NoPass, states.last().unwrap()).unwrap();
    assert!(without_clocks(whole) == without_clocks(resumed));
}

#[test]
fn states_that_no_solve_of_this_scene_can_have_are_refused() {
    let prepared = prepared(coloured());
    let config = config(Technique::Normal);
    let album = Album::default();
    solve(&prepared, &config, &album).unwrap();
    let states = album.0.into_inner().unwrap();
    let bytes = states[1].as_bytes();
    let refused = |bytes: Vec<u8>, what: &str| {
        let outcome = resume(&prepared, &config, &Silent, &Snapshot::from_bytes(bytes));
        assert!(matches!(outcome, Err(SolveError::Snapshot(_))), "{what}");
    };
    for length in (0..bytes.len()).step_by(bytes.len() / 200) {
        refused(bytes[..length].to_vec(), "truncated");
    }
    let mut longer = bytes.to_vec();
    longer.push(0);
    refused(longer, "too long");

    // Channels, passes, number of the first pass.
    for at in [0, 4, 8] {
        let mut other = bytes.to_vec();
        other[at] ^= 2;
        refused(other, "numbers");
    }
    let owners = 8 + 2 * (4 + 8 + 11 * 8 + 8 + 8) + 3 * 8;
    let count = u32::from_le_bytes(bytes[owners..owners + 4].try_into().unwrap());
    let facets = u32::from_le_bytes(bytes[owners + 4..owners + 8].try_into().unwrap());
    assert_eq!(facets as usize, prepared.hierarchy.facets.len());
    assert!(count > 1 && count <= facets);
    // The first child of the first facet: itself, out of range, out of step.
    let first_child = owners + 16;
    for child in [1u32, 2, 3, u32::MAX, 1 << 20] {
        let mut other = bytes.to_vec();
        if bytes[first_child..first_child + 4] == child.to_le_bytes() {
            continue;
        }
        other[first_child..first_child + 4].copy_from_slice(&child.to_le_bytes());
        refused(other, "tree");
    }
    // A number of patches that would need more memory than there is.
    let mut other = bytes.to_vec();
    other[owners + 12..owners + 16].copy_from_slice(&u32::MAX.to_le_bytes());
    refused(other, "count");
    let mut other = bytes.to_vec();
    let end = other.len();
    other[end - 4..].copy_from_slice(&f32::NAN.to_le_bytes());
    refused(other, "not a number");

    let grey = self::prepared(grey(0.5, 1.0));
    let outcome = resume(&grey, &config, &Silent, &states[1]);
    assert!(matches!(outcome, Err(SolveError::Snapshot(_))), "channels");
    let audited = SolveConfig {
        keep_claims: 1,
        ..config
    };
    let outcome = resume(&prepared, &audited, &Silent, &states[1]);
    assert!(matches!(outcome, Err(SolveError::Snapshot(_))), "claims");
}

#[test]
fn a_state_holds_the_passes_so_far() {
    let prepared = prepared(grey(0.7, 1.0));
    let config = config(Technique::Normal);
    let album = Album::default();
    let whole = solve(&prepared, &config, &album).unwrap();
    let states = album.0.into_inner().unwrap();
    struct First(Mutex<Option<u32>>);
    impl Observer for First {
        fn pass_done(&self, statistics: &PassStatistics, _: f64) {
            self.0.lock().unwrap().get_or_insert(statistics.pass);
        }
    }
    for (k, state) in states.iter().enumerate().take(2) {
        let first = First(Mutex::default());
        let resumed = resume(&prepared, &config, &first, state).unwrap();
        assert_eq!(first.0.into_inner().unwrap(), Some(k as u32 + 2));
        // The clocks of the earlier passes come from the state.
        assert_eq!(resumed.passes[..=k], whole.passes[..=k]);
    }
}
