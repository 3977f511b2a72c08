//! What goes to which stream.

use crate::command::{COARSE, Folder, write_room};
use std::io::Read;

#[test]
fn quiet_says_nothing_on_success() {
    let folder = Folder::new();
    write_room(&folder);
    for line in [
        "solve room.obj --out results --quiet --epsilon 1e-3",
        "--quiet view results --out x.png --size 64x48",
        "generate cornell --out scenes --quiet",
        "clusters room.obj --out clusters.ply --quiet",
    ] {
        let run = folder.line(line);
        run.ends_with(0, line);
        assert_eq!(
            (run.stdout.as_str(), run.stderr.as_str()),
            ("", ""),
            "{line}"
        );
    }
}

#[test]
fn no_progress_where_there_is_no_terminal() {
    let folder = Folder::new();
    let run = folder.line("solve builtin:cornell --out results --no-view --epsilon 1e-3");
    run.ends_with(0, "solve");
    for text in [&run.stdout, &run.stderr] {
        let control = text.chars().find(|c| c.is_control() && *c != '\n');
        assert_eq!(control, None, "{text:?}");
    }
    assert!(run.stdout.contains("imbalance"), "{}", run.stdout);
}

#[test]
fn errors_go_to_standard_error_even_when_quiet() {
    let folder = Folder::new();
    let run = folder.line("solve missing.obj --out results --quiet");
    run.ends_with(2, "missing").says(&["missing.obj"]);
    assert_eq!(run.stdout, "");
}

#[test]
fn warnings_name_what_was_dropped() {
    let folder = Folder::new();
    write_room(&folder);
    let obj = crate::command::ROOM[0].replace("usemtl lamp", "f 1 1 2\nusemtl lamp");
    folder.write("flawed.obj", obj);
    folder
        .line(&format!("solve flawed.obj --out results {COARSE}"))
        .ends_with(0, "a face without area")
        .says(&["warning", "flawed.obj"]);
    let stats = folder.stats("results");
    assert_eq!(stats["scene"]["dropped_faces"], serde_json::json!([6]));
    assert!(!stats["scene"]["warnings"].as_array().unwrap().is_empty());
}

/// As with `certilux generate --list | head -1`.
#[test]
fn a_reader_that_leaves_early_is_no_failure() {
    let folder = Folder::new();
    write_room(&folder);
    for line in [
        "generate --list".to_owned(),
        "--help".to_owned(),
        format!("solve room.obj --out results {COARSE}"),
    ] {
        let words: Vec<&str> = line.split_whitespace().collect();
        let mut child = folder.command(&words).spawn().unwrap();
        drop(child.stdout.take());
        let mut stderr = String::new();
        (child.stderr.take().unwrap())
            .read_to_string(&mut stderr)
            .unwrap();
        assert_eq!(child.wait().unwrap().code(), Some(0), "{line}: {stderr}");
        assert_eq!(stderr, "", "{line}");
    }
    assert_eq!(folder.names("results"), ["solution.ply", "stats.json"]);
}
