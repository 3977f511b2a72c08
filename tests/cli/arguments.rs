//! Wrong arguments end with 2 and name the flag; help and version end with 0.

use crate::command::{Folder, write_room};

#[test]
fn help_and_version_are_no_errors() {
    let folder = Folder::new();
    for line in [
        "--help",
        "-h",
        "help",
        "help solve",
        "solve --help",
        "view --help",
        "generate --help",
        "clusters --help",
        "--version",
        "-V",
    ] {
        let run = folder.line(line);
        run.ends_with(0, line);
        assert!(run.stdout.contains("certilux"), "{line}: {}", run.stdout);
        assert_eq!(run.stderr, "", "{line}");
    }
}

#[test]
fn what_cannot_be_parsed_ends_with_two() {
    let folder = Folder::new();
    write_room(&folder);
    for line in [
        "",
        "paint",
        "solve",
        "solve room.obj",
        "solve --out x",
        "solve room.obj extra.obj --out x",
        "solve room.obj --out x --no-such-flag",
        "solve room.obj --out x --epsilon",
        "solve room.obj --out x --epsilon small",
        "solve room.obj --out x --epsilon 1e-5 --epsilon 1e-6",
        "solve room.obj --out x --technique magic",
        "solve room.obj --out x --sides three",
        "solve room.obj --out x --rays 1.5",
        "solve room.obj --out x --rays 99999999999",
        "solve room.obj --out x --passes 3 --converge 0.1",
        "solve room.obj --out x --seed -1",
        "solve room.obj --out x --threads -1",
        "generate",
        "generate cornell",
        "view results",
        "clusters room.obj",
        "clusters room.obj --out c.ply --count 0",
        "clusters room.obj --out c.png",
        "occluders room.obj --out o.ply",
        "audit room.obj --rays-per-claim 0",
    ] {
        let run = folder.line(line);
        run.ends_with(2, line);
        assert!(!run.stderr.is_empty(), "{line}");
        assert_eq!(run.stdout, "", "{line}");
    }
    assert_eq!(folder.names("."), ["room.mtl", "room.obj"]);
}

#[test]
fn settings_out_of_range_end_with_two_and_name_the_flag() {
    let folder = Folder::new();
    write_room(&folder);
    for (flag, values) in [
        ("--epsilon", "0 -0.0 -1 NaN inf -inf 1e-400"),
        ("--gradient", "0 -1 NaN inf"),
        ("--rays", "0 -1 1048577"),
        ("--passes", "0 -1"),
        ("--converge", "0 -1 NaN inf"),
        ("--min-area", "-1 NaN inf"),
        ("--threads", "1000000 18446744073709551615"),
    ] {
        for value in values.split_whitespace() {
            let line = format!("solve room.obj --out x {flag}={value}");
            folder.line(&line).ends_with(2, &line).says(&[flag]);
        }
    }
    assert_eq!(folder.names("."), ["room.mtl", "room.obj"]);
}

#[test]
fn an_unknown_builtin_scene_is_answered_with_the_nearest_names() {
    let folder = Folder::new();
    for line in [
        "solve builtin:cornel --out x",
        "generate cornel --out x",
        "clusters builtin:cornel --out x.ply",
    ] {
        folder.line(line).ends_with(2, line).says(&["cornell"]);
    }
    for line in ["solve builtin: --out x", "generate ../x --out y"] {
        folder.line(line).ends_with(2, line);
    }
    assert!(folder.names(".").is_empty(), "{:?}", folder.names("."));
}

/// A number below zero is a value of the flag before it, and is told why it is none.
#[test]
fn negative_numbers_are_answered_with_what_is_needed() {
    let folder = Folder::new();
    write_room(&folder);
    for (line, words) in [
        ("solve room.obj --out x --seed -1", "whole number from 0"),
        ("solve room.obj --out x --threads -1", "from 0 to"),
        (
            "solve room.obj --out x --occluders -1",
            "whole number from 0",
        ),
        ("solve room.obj --out x --passes -1", "is not in 0.."),
        ("solve room.obj --out x --stride -1", "whole number from 1"),
        ("audit room.obj --claims -1", "whole number from 1"),
        ("audit room.obj --rays-per-claim -1", "is not in 1.."),
        ("audit room.obj --brute-force -1", "whole number from 0"),
        (
            "sweep room.obj --out x --occluders 2,-1",
            "whole number from 0",
        ),
        ("sweep room.obj --out x --repeat -1", "is not in 1.."),
        (
            "reference room.obj --out x.json --seed -1",
            "whole number from 0",
        ),
        ("compare room.obj --repeat -1", "is not in 1.."),
        ("bench --threads -1", "from 0 to"),
    ] {
        let run = folder.line(line);
        run.ends_with(2, line).says(&["invalid value '-1'", words]);
        assert!(!run.stderr.contains("tip:"), "{line}: {}", run.stderr);
    }
}

#[test]
fn names_that_are_none_are_not_printed_as_if_they_were() {
    let folder = Folder::new();
    write_room(&folder);
    let run = folder.run(&["solve", "", "--out", "x"]);
    run.ends_with(2, "no name").says(&["its name is empty"]);
    assert!(!run.stderr.contains(": :"), "{}", run.stderr);
    folder
        .line("occluders room.obj --out o.ply")
        .ends_with(2, "ending")
        .says(&["an OBJ file is written"]);
}
