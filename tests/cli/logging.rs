//! Messages as JSON, and `RUST_LOG`.

use crate::command::{Folder, Outcome, write_room};
use serde_json::Value;

fn run(folder: &Folder, line: &str, filter: Option<&str>) -> Outcome {
    let words: Vec<&str> = line.split_whitespace().collect();
    let mut command = folder.command(&words);
    if let Some(filter) = filter {
        command.env("RUST_LOG", filter);
    }
    Outcome::of(command.output().unwrap())
}

/// Every line of standard error as JSON.
fn lines(run: &Outcome) -> Vec<Value> {
    let parse = |line: &str| serde_json::from_str(line).unwrap_or_else(|e| panic!("{e}: {line}"));
    run.stderr.lines().map(parse).collect()
}

#[test]
fn with_json_logs_every_line_is_json() {
    let folder = Folder::new();
    write_room(&folder);
    let solved = run(
        &folder,
        "solve room.obj --out results --no-view --epsilon 1e-3 --passes 3 --json-logs",
        None,
    );
    solved.ends_with(0, "solve");
    let said = lines(&solved);
    let passes: Vec<u64> = said
        .iter()
        .filter_map(|line| line["pass"].as_u64())
        .collect();
    assert_eq!(passes, [1, 2, 3]);
    let pass = said.iter().find(|line| line["pass"] == 2).unwrap();
    assert_eq!(pass["message"], "pass done");
    assert_eq!(
        pass["exchanges"],
        folder.stats("results")["passes"][1]["exchanges"]
    );
    assert!(pass["timestamp"].is_string() && pass["level"] == "INFO");

    let obj = crate::command::ROOM[0].replace("usemtl lamp", "f 1 1 2\nusemtl lamp");
    folder.write("odd.obj", obj);
    let warned = run(
        &folder,
        "solve odd.obj --out odd --no-view --epsilon 1e-2 --json-logs --quiet",
        Some("warn"),
    );
    warned.ends_with(0, "odd");
    let said = lines(&warned);
    assert_eq!(said.len(), 1, "{said:?}");
    assert_eq!(said[0]["level"], "WARN");
    assert!(said[0]["message"].as_str().unwrap().contains("odd.obj"));

    for (line, code) in [
        ("solve missing.obj --out x --json-logs", 2),
        ("solve room.obj --json-logs", 2),
        ("--json-logs solve room.obj --out x --epsilon 0", 2),
        ("--json-logs sovle", 2),
    ] {
        let failed = run(&folder, line, None);
        failed.ends_with(code, line);
        let said = lines(&failed);
        let last = said.last().unwrap();
        assert_eq!(last["level"], "ERROR", "{line}");
        assert_eq!(last["exit_code"], code, "{line}");
    }
    let help = run(&folder, "solve --help --json-logs", None);
    help.ends_with(0, "help");
    assert_eq!(help.stderr, "");
}

#[test]
fn the_filter_asks_for_more_or_is_refused() {
    let folder = Folder::new();
    write_room(&folder);
    let line = "solve room.obj --out results --no-view --epsilon 1e-2 --passes 2";
    let silent = run(&folder, line, None);
    silent.ends_with(0, "silent");
    assert_eq!(silent.stderr, "");
    let told = run(&folder, line, Some("certilux=info"));
    told.ends_with(0, "told")
        .says(&["pass done", "pass=2", "INFO"]);
    assert!(!told.stderr.contains('\u{1b}'));
    run(&folder, line, Some("certilux=loud"))
        .ends_with(2, "filter")
        .says(&["RUST_LOG=certilux=loud"]);
}

/// Colours are for terminals, and there only unless `NO_COLOR` is set.
#[test]
fn no_colours_where_nobody_sees_them() {
    let folder = Folder::new();
    for line in ["solve", "solve --epsilom 3", "--help", "frobnicate"] {
        let words: Vec<&str> = line.split_whitespace().collect();
        let mut command = folder.command(&words);
        command.env("NO_COLOR", "1").env("TERM", "xterm-256color");
        let run = Outcome::of(command.output().unwrap());
        assert!(
            !run.stderr.contains('\u{1b}') && !run.stdout.contains('\u{1b}'),
            "{line}"
        );
    }
}
