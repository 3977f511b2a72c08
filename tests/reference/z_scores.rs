//! The error bars themselves: over many faces of known radiosity the z-scores are distributed as they should.

use crate::measured::Measured;
use std::f64::consts::PI;

/// What a t-distributed score of `freedom` degrees would be as a normal one (Wallace 1959; good to a few
/// thousandths from ten degrees on).
fn as_normal(t: f64, freedom: f64) -> f64 {
    let size = (freedom * (t * t / freedom).ln_1p()).sqrt();
    (size * (8.0 * freedom + 1.0) / (8.0 * freedom + 3.0)).copysign(t)
}

/// Normal distribution function, by Abramowitz and Stegun 7.1.26 (to 1.5e-7).
fn below(z: f64) -> f64 {
    let x = z.abs() / 2f64.sqrt();
    let t = 1.0 / (1.0 + 0.327_591_1 * x);
    let polynomial = t
        * (0.254_829_592
            + t * (-0.284_496_736
                + t * (1.421_413_741 + t * (-1.453_152_027 + t * 1.061_405_429))));
    let tail = 0.5 * polynomial * (-x * x).exp();
    if z > 0.0 { 1.0 - tail } else { tail }
}

/// What speaks against the scores being independent and normal, each test at a level of about 1e-3.
fn complaints(name: &str, mut scores: Vec<f64>) -> Vec<&'static str> {
    let n = scores.len() as f64;
    assert!(n > 100.0);
    let mean = scores.iter().sum::<f64>() / n.sqrt();
    // Wilson and Hilferty 1931: the cube root of a chi-square over its degrees is nearly normal.
    let squares: f64 = scores.iter().map(|z| z * z).sum();
    let spread = 2.0 / (9.0 * n);
    let chi_square = ((squares / n).cbrt() - (1.0 - spread)) / spread.sqrt();
    scores.sort_by(f64::total_cmp);
    let kolmogorov = (scores.iter().enumerate())
        .map(|(i, &z)| {
            let p = below(z);
            (p - i as f64 / n).abs().max((p - (i + 1) as f64 / n).abs())
        })
        .fold(0.0, f64::max)
        * n.sqrt();
    let greatest = scores.iter().fold(0.0f64, |m, z| m.max(z.abs()));
    eprintln!(
        "{name:<28} {n} scores: mean {mean:.2}, chi-square {chi_square:.2} (both normal), KS {kolmogorov:.2}, greatest {greatest:.2}"
    );
    [
        (mean.abs() > 3.3, "the mean leans"),
        (chi_square > 3.3, "the error bars are too small"),
        (chi_square < -3.3, "the error bars are too large"),
        (kolmogorov > 1.95, "the distribution is not normal"),
        // 1e-3 over a few hundred faces.
        (greatest > 4.9, "one is too far out"),
    ]
    .into_iter()
    .filter_map(|(found, what)| found.then_some(what))
    .collect()
}

#[test]
fn of_furnaces() {
    for (name, error) in [
        ("furnace-0.5", 0.01),
        ("furnace-blocks-0.5", 0.01),
        ("furnace-tjunctions-0.8", 0.02),
    ] {
        let measured = Measured::builtin(name, error);
        let rho = measured.reference.faces[0].reflectance[0];
        let want = PI / (1.0 - rho);
        let scores = measured
            .reference
            .faces
            .iter()
            .map(|f| {
                let t = (f.radiosity[0] - want) / f.standard_error[0];
                as_normal(t, (f.batches - 1) as f64)
            })
            .collect();
        assert_eq!(complaints(name, scores), [""; 0], "{name}");
    }
}

/// What is done to honest scores, and what must be said of it.
type Wrong = (fn(f64) -> f64, &'static str);

#[test]
fn the_checks_see_a_lean_and_bars_that_are_too_small() {
    let honest = |i: i32| {
        // Normal scores by inverting `below` through bisection.
        let p = (f64::from(i) + 0.5) / 400.0;
        let (mut low, mut high) = (-6.0, 6.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if below(middle) < p {
                low = middle
            } else {
                high = middle
            }
        }
        low
    };
    let scores = (0..400).map(honest);
    assert!(complaints("honest", scores.clone().collect()).is_empty());
    let wrongs: [Wrong; 3] = [
        (|z| z + 0.25, "the mean leans"),
        (|z| 1.3 * z, "the error bars are too small"),
        (|z| 0.75 * z, "the error bars are too large"),
    ];
    for (wrong, what) in wrongs {
        let found = complaints(what, scores.clone().map(wrong).collect());
        assert!(found.contains(&what), "{what}: {found:?}");
    }
}
