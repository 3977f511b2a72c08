//! Every setting of a solve that affects the light, as text: what results and checkpoints are known by.

use super::args::SolveCommand;
use crate::solve::{SolveConfig, Stop, Stride};
use clap::ValueEnum;
use std::collections::BTreeMap;

/// The settings by the names of their flags, in a form that the flags read back exactly. The number of threads
/// and what is written are no part of it, nor is the clamping of reflectances, which the scene shows.
pub fn settings(command: &SolveCommand, config: &SolveConfig) -> BTreeMap<String, String> {
    // Named one by one, so that a new field cannot be forgotten.
    let &SolveConfig {
        technique,
        epsilon,
        gradient,
        rays,
        stop,
        min_area,
        seed,
        normalise: _,
        stride,
        keep_claims: _,
        keep_blocked: _,
        check_claims: _,
    } = config;
    let occluders = command.solve.occluders.config();
    let real = |x: f64| format!("{x:e}");
    let stop = match stop {
        Stop::Passes(n) => ("passes", n.to_string()),
        Stop::Converged(x) => ("converge", real(x)),
    };
    let stride = match stride {
        Stride::Every(levels) => levels.to_string(),
        Stride::Auto => "auto".to_owned(),
    };
    [
        stop,
        ("technique", technique.name().to_owned()),
        ("epsilon", real(epsilon)),
        ("gradient", real(gradient)),
        ("rays", rays.to_string()),
        ("min-area", real(min_area)),
        ("seed", seed.to_string()),
        ("normalise", name_of(command.solve.normalise)),
        ("stride", stride),
        ("sides", name_of(command.scene.reading.sides)),
        ("axes", name_of(command.scene.reading.axes)),
        ("occluders", occluders.per_cluster.to_string()),
        ("occluder-size", real(occluders.min_area)),
        ("flatness", real(occluders.flatness_degrees)),
    ]
    .map(|(name, value)| (name.to_owned(), value))
    .into()
}

/// What the command line calls a choice.
fn name_of(value: impl ValueEnum) -> String {
    value
        .to_possible_value()
        .map_or_else(String::new, |v| v.get_name().to_owned())
}

#[cfg(test)]
mod tests {
    use super::super::args::{Cli, Command};
    use super::*;
    use clap::Parser;

    fn parsed(words: &[String]) -> (SolveCommand, SolveConfig) {
        let start = ["certilux", "solve", "x.obj", "--out", "y"].map(str::to_owned);
        let cli = Cli::try_parse_from(start.iter().chain(words)).unwrap();
        let Command::Solve(command) = cli.command else {
            panic!("another command");
        };
        let config = command.solve.config().unwrap();
        (command, config)
    }

    fn of(words: &[String]) -> BTreeMap<String, String> {
        let (command, config) = parsed(words);
        settings(&command, &config)
    }

    #[test]
    fn settings_read_back_as_flags_give_the_same_solve() {
        let lines = [
            "",
            "--technique blockers --epsilon 3.3e-7 --gradient 0.1 --rays 24 --passes 7 --min-area 0 --seed 18446744073709551615",
            "--normalise off --stride 4 --sides two --axes file --occluders 3 --occluder-size 0.00123 --flatness 2.5 --converge 0.017",
        ];
        for line in lines {
            let words: Vec<String> = line.split_whitespace().map(str::to_owned).collect();
            let first = of(&words);
            let flags: Vec<String> = first.iter().map(|(k, v)| format!("--{k}={v}")).collect();
            assert_eq!(of(&flags), first, "{line}");
            assert_eq!(parsed(&flags).1, parsed(&words).1, "{line}");
        }
        assert_ne!(of(&[]), of(&["--sides=two".to_owned()]));
        assert_ne!(of(&[]), of(&["--axes=file".to_owned()]));
    }
}
