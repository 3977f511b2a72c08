//! Settings at the ends of their ranges. What lies outside is refused: `tests/cli/arguments.rs`.

use crate::agreement::{coarse, hold, prepare, solve_by};
use crate::mesh::{Facing, Mesh};
use certilux::solve::{PreparedScene, SolveConfig, Stop, Technique};
use glam::DVec3;

fn room() -> PreparedScene {
    let (min, max) = (DVec3::new(-0.6, -1.0, -0.5), DVec3::new(0.4, 0.1, 0.3));
    prepare(&Mesh::room().cuboid("red", min, max, Facing::Outwards))
}

#[test]
fn any_number_of_threads_from_1_to_64_gives_the_same_bits() {
    let prepared = room();
    let mut config = coarse();
    config.stop = Stop::Passes(3);
    for technique in [
        Technique::Normal,
        Technique::Visibility,
        Technique::Occlusion,
        Technique::Blockers,
    ] {
        let on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap();
            pool.install(|| solve_by(&prepared, technique, &config))
        };
        let (one, many) = (on(1), on(64));
        assert!(
            one.solution.patches == many.solution.patches,
            "{}",
            technique.name()
        );
        for (a, b) in one.passes.iter().zip(&many.passes) {
            let mut b = *b;
            b.seconds = a.seconds;
            assert_eq!(*a, b);
        }
        assert_eq!(one.power, many.power);
    }
}

#[test]
fn a_huge_epsilon_or_gradient_still_conserves_power() {
    let prepared = room();
    for (epsilon, gradient) in [(1.0, 1.0), (1.0e300, 1.0), (f64::MAX, f64::MAX)] {
        let mut config = SolveConfig::default();
        config.epsilon = epsilon;
        config.gradient = gradient;
        let what = format!("epsilon {epsilon:e}");
        hold(&what, &prepared, &config);
        let power = solve_by(&prepared, Technique::Occlusion, &config).power;
        println!("{what}: imbalance {:+.4}", power.imbalance);
        assert!(power.imbalance.abs() < 0.2, "{power:?}");
    }
}

#[test]
fn one_ray_and_4096() {
    let prepared = room();
    for rays in [1, 4096] {
        let mut config = coarse();
        config.rays = rays;
        if rays > 1 {
            config.epsilon = 1.0e-2;
            config.gradient = 1.0;
        }
        config.min_area = 1.0e-3;
        let claims = hold(&format!("{rays} rays"), &prepared, &config);
        assert!(claims.visible > 0);
        config.stop = Stop::Passes(2);
        let power = solve_by(&prepared, Technique::Occlusion, &config).power;
        println!("{rays} rays: imbalance {:+.4}", power.imbalance);
        assert!(power.imbalance.abs() < 0.2, "{power:?}");
    }
}

#[test]
fn smallest_patches_of_any_size() {
    let prepared = room();
    for min_area in [0.0, 1.0, f64::MAX] {
        let mut config = coarse();
        config.epsilon = 1.0e-3;
        config.gradient = 0.5;
        config.min_area = min_area;
        hold(&format!("smallest patch {min_area:e}"), &prepared, &config);
    }
}
