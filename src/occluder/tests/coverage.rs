//! Most of a wall is covered, whatever its doors and windows.

use super::builders::{Placement, Random, Wall, extract};
use glam::DVec2;

#[test]
fn walls_with_doors_and_windows_are_covered() {
    let mut random = Random::new(77);
    let (mut covered, mut area, mut least) = (0.0, 0.0, 1.0f64);
    for seed in 0..40 {
        let size = DVec2::new(random.between(0.3, 0.7), random.between(0.1, 0.3));
        let door = random.between(0.02, 0.7) * size.x;
        let mut holes = vec![[
            DVec2::new(door, 0.0),
            DVec2::new(door + 0.2 * size.y, 0.75 * size.y),
        ]];
        for _ in 0..random.below(4) {
            let low = DVec2::new(random.between(0.0, 0.8), random.between(0.2, 0.5)) * size;
            holes.push([low, low + DVec2::new(0.3, 0.4) * size.y]);
        }
        let wall = Wall { size, holes };
        let (_, set) = extract(&Placement::turned(seed).place(&wall.cut_at_random(500, seed)));
        let share = set.statistics.covered_area / wall.area();
        least = least.min(share);
        covered += set.statistics.covered_area;
        area += wall.area();
    }
    println!("covered {:.4}, least {least:.4}", covered / area);
    assert!(covered / area > 0.95 && least > 0.85);
}

#[test]
fn a_gable_and_a_disc_are_mostly_covered() {
    let p = DVec2::new;
    let gable = [
        [p(0.0, 0.0), p(0.4, 0.0), p(0.4, 0.2)],
        [p(0.0, 0.0), p(0.4, 0.2), p(0.0, 0.2)],
        [p(0.0, 0.2), p(0.4, 0.2), p(0.2, 0.32)],
    ];
    let disc: Vec<[DVec2; 3]> = (0..60)
        .map(|i| {
            let at = |i: i32| 0.2 * DVec2::from_angle(f64::from(i) * std::f64::consts::TAU / 60.0);
            [DVec2::ZERO, at(i), at(i + 1)]
        })
        .collect();
    for (mesh, least) in [(&gable[..], 0.85), (&disc[..], 0.85)] {
        let (_, set) = extract(&Placement::plain().place(mesh));
        let share = set.statistics.covered_share();
        println!("covered {share:.4} with {}", set.occluders.len());
        assert!(share > least, "{share}");
    }
}
