//! Defaults from `certilux.toml` and the environment.

use crate::command::{Folder, Outcome, write_room};

/// A folder with the room and this configuration file.
fn folder(configuration: &str) -> Folder {
    let folder = Folder::new();
    write_room(&folder);
    folder.write("certilux.toml", configuration);
    folder
}

fn solve(folder: &Folder, more: &str, variables: &[(&str, &str)]) -> Outcome {
    let line = format!("solve room.obj --no-view --out results {more}");
    let words: Vec<&str> = line.split_whitespace().collect();
    let mut command = folder.command(&words);
    command.envs(variables.iter().copied());
    Outcome::of(command.output().unwrap())
}

#[test]
fn a_flag_is_above_a_variable_above_the_file() {
    let folder =
        folder("epsilon = 1e-2\nseed = 3\n[solve]\nepsilon = 2e-3\nrays = 16\n[view]\nfov = 30\n");
    let of = |more: &str, variables: &[(&str, &str)], want: (f64, u64, u64)| {
        solve(&folder, more, variables).ends_with(0, more);
        let stats = folder.stats("results");
        let found = (
            stats["epsilon"].as_f64().unwrap(),
            stats["seed"].as_u64().unwrap(),
            stats["rays_per_exchange"].as_u64().unwrap(),
        );
        assert_eq!(found, want, "{more} {variables:?}");
    };
    of("", &[], (2e-3, 3, 16));
    of("--epsilon 4e-3", &[], (4e-3, 3, 16));
    of("", &[("CERTILUX_EPSILON", "3e-3")], (3e-3, 3, 16));
    of(
        "--epsilon 4e-3",
        &[("CERTILUX_EPSILON", "3e-3")],
        (4e-3, 3, 16),
    );
    of(
        "--seed 4",
        &[("CERTILUX_RAYS", "24"), ("CERTILUX_SEED", "")],
        (2e-3, 4, 24),
    );
    of(
        "--epsilon 1e-3 --no-config",
        &[("CERTILUX_SEED", "9")],
        (1e-3, 1, 8),
    );
}

#[test]
fn what_excludes_a_default_overrules_it() {
    let folder = folder("[solve]\npasses = 1\nepsilon = 1e-3\n");
    let passes = || folder.stats("results")["settings"].clone();
    solve(&folder, "", &[]).ends_with(0, "file");
    assert_eq!(passes()["passes"], "1");
    solve(&folder, "--converge 0.5", &[]).ends_with(0, "flag");
    assert_eq!(passes()["converge"], "5e-1");
    solve(&folder, "", &[("CERTILUX_CONVERGE", "0.25")]).ends_with(0, "variable");
    assert_eq!(passes()["converge"], "2.5e-1");
    solve(&folder, "--passes 2", &[("CERTILUX_CONVERGE", "0.25")]).ends_with(0, "both");
    assert_eq!(passes()["passes"], "2");
}

#[test]
fn files_that_cannot_be_used_are_refused_with_the_line() {
    for (text, words) in [
        (
            "[solve]\nepsilom = 1\n",
            "certilux.toml:2: unknown key `epsilom`; did you mean `epsilon`?",
        ),
        (
            "epsilom = 1\n",
            "certilux.toml:1: unknown key `epsilom`; did you mean `epsilon`?",
        ),
        (
            "[solv]\nepsilon = 1\n",
            "certilux.toml:1: no command `solv`; did you mean `solve`?",
        ),
        (
            "[view]\nsize = \"big\"\n",
            "certilux.toml:2: `size`: invalid value",
        ),
        (
            "[solve]\n\nepsilon = 0\n",
            "certilux.toml:3: `epsilon`: --epsilon must be",
        ),
        ("[solve]\nout = \"elsewhere\"\n", "unknown key `out`"),
        ("[compare]\njson = \"overwritten\"\n", "unknown key `json`"),
        ("no-view = 3\n", "true or false"),
        ("= 3\n", "certilux.toml:1: "),
    ] {
        let folder = folder(text);
        solve(&folder, "", &[]).ends_with(2, text).says(&[words]);
        assert!(!folder.path("results").exists());
        solve(&folder, "--no-config --epsilon 1e-3", &[]).ends_with(0, text);
    }
    let folder = folder("");
    for (name, value, words) in [
        (
            "CERTILUX_EPSILON",
            "-1",
            "CERTILUX_EPSILON: --epsilon must be",
        ),
        (
            "CERTILUX_THREADS",
            "many",
            "CERTILUX_THREADS: invalid value",
        ),
        ("CERTILUX_NO_VIEW", "maybe", "CERTILUX_NO_VIEW: 1 or 0"),
        ("CERTILUX_CONFIG", "missing.toml", "missing.toml"),
    ] {
        solve(&folder, "", &[(name, value)])
            .ends_with(2, name)
            .says(&[words]);
    }
    // A name that looks like that of a variable is worth a word; one that does not may be another program's.
    for (name, words) in [
        ("CERTILUX_EPSILOM", "did you mean CERTILUX_EPSILON?"),
        ("CERTILUX_RESUME", "on the command line only"),
        ("CERTILUX_DEBIAN13", ""),
    ] {
        let run = solve(&folder, "--epsilon 1e-3", &[(name, "1")]);
        run.ends_with(0, name).says(&[words]);
        assert_eq!(run.stderr.is_empty(), words.is_empty(), "{}", run.stderr);
        let run = solve(&folder, "--epsilon 1e-3 --no-config", &[(name, "1")]);
        assert_eq!(run.ends_with(0, name).stderr, "");
    }
    // A typed flag cannot be wrong because of a variable that it overrules.
    solve(
        &folder,
        "--epsilon 1e-3",
        &[("CERTILUX_TECHNIQUE", "normal")],
    )
    .ends_with(0, "technique");
    assert_eq!(folder.stats("results")["technique"], "normal");
}

#[test]
fn the_command_line_may_end_its_flags_and_hold_other_flags_first() {
    let folder = folder("epsilon = 1e-3\nno-view = true\nquiet = false\n");
    for words in [
        &["--quiet", "solve", "--out=results", "--", "room.obj"][..],
        &["solve", "room.obj", "--out", "results", "-q"],
    ] {
        let run = folder.run(words);
        run.ends_with(0, "solve");
        assert_eq!(run.stdout, "");
        assert_eq!(folder.stats("results")["epsilon"], 1e-3);
        assert_eq!(folder.names("results"), ["solution.ply", "stats.json"]);
    }
    // Help and commands without such flags do not mind.
    folder.line("generate --list").ends_with(0, "list");
    folder.write("certilux.toml", "[solve]\nepsilom = 1\n");
    folder.line("solve --help").ends_with(0, "help");
}

/// Lists have the names of numbers, and no quality stands beside them.
#[test]
fn a_sweep_has_defaults_like_a_solve() {
    let folder = folder("[sweep]\nepsilon = [3e-3, 1e-2]\n");
    let sweep = |more: &str, variables: &[(&str, &str)]| {
        let line = format!(
            "sweep room.obj --out swept --quick --reference-seconds 0.1 --gradient 0.1 --min-area 1e-3 {more}"
        );
        let words: Vec<&str> = line.split_whitespace().collect();
        let mut command = folder.command(&words);
        command.envs(variables.iter().copied());
        Outcome::of(command.output().unwrap())
    };
    let rows = || -> serde_json::Value {
        let text = std::fs::read(folder.path("swept/sweep.json")).unwrap();
        serde_json::from_slice(&text).unwrap()
    };
    let variables = [
        ("CERTILUX_THREADS", "1"),
        ("CERTILUX_SEED", "7"),
        ("CERTILUX_TECHNIQUE", "normal"),
        ("CERTILUX_RAYS", "8"),
        ("CERTILUX_PASSES", "1"),
    ];
    sweep("", &variables).ends_with(0, "variables");
    let found = rows();
    assert_eq!(found["key"]["seed"], 7);
    assert_eq!(found["key"]["threads"], 1);
    let epsilons = |found: &serde_json::Value| -> Vec<f64> {
        let rows = found["rows"].as_array().unwrap();
        let epsilons = rows
            .iter()
            .map(|row| row["settings"]["epsilon"].as_f64().unwrap());
        epsilons.collect()
    };
    assert_eq!(epsilons(&found), [3e-3, 1e-2]);
    let above = [
        ("CERTILUX_EPSILON", "5e-3"),
        ("CERTILUX_TECHNIQUE", "normal"),
    ];
    sweep("--rays 8", &above).ends_with(0, "a variable above the file");
    assert_eq!(epsilons(&rows()), [5e-3]);
    for (name, value) in [("CERTILUX_EPSILON", "-1"), ("CERTILUX_RAYS", "0")] {
        let run = sweep("", &[(name, value)]);
        run.ends_with(2, name).says(&[name]);
    }
}
