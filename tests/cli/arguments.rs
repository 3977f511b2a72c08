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
