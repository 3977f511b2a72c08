//! `compare`: the table's columns are a contract, and its rows compare the same work.

use crate::command::Folder;
use std::fs;

const COLUMNS: &str = "scene,pass,technique,seconds,exchanges,exchanges_blocked,rays,rays_blocked,native_rays,shafts,\
max_occlusion_percent,detected_occlusion_percent,full_visibility_percent,visibility_cost_removed_percent,speedup";

#[test]
fn techniques_are_compared_on_the_same_work() {
    let folder = Folder::new();
    folder
        .line(
            "compare builtin:cornell --epsilon 1e-4 --passes 2 --repeat 2 --csv t.csv --json t.json --markdown t.md",
        )
        .ends_with(0, "compare");
    let csv = fs::read_to_string(folder.path("t.csv")).unwrap();
    let mut lines = csv.lines();
    assert_eq!(lines.next(), Some(COLUMNS));
    let rows: Vec<Vec<&str>> = lines.map(|l| l.split(',').collect()).collect();
    let names = [
        "normal",
        "visibility",
        "occlusion",
        "blockers",
        "unoccluded",
    ];
    assert_eq!(rows.len(), 2 * names.len());
    let number = |row: &[&str], column: &str| -> f64 {
        let at = COLUMNS.split(',').position(|c| c == column).unwrap();
        row[at].parse().unwrap()
    };
    for (pass, rows) in rows.chunks(names.len()).enumerate() {
        for (row, name) in rows.iter().zip(names) {
            assert_eq!(row[..3], ["builtin:cornell", &(pass + 1).to_string(), name]);
            assert!(number(row, "seconds") > 0.0);
        }
        let [normal, visibility, occlusion, blockers, unoccluded] = rows else {
            panic!("five techniques");
        };
        // Visibility proofs save rays and no exchange; occlusion proofs save exchanges that are blocked or carry no
        // light along any sample.
        assert_eq!(number(normal, "exchanges"), number(visibility, "exchanges"));
        let missing = number(normal, "exchanges") - number(occlusion, "exchanges");
        let unblocked =
            number(normal, "exchanges_blocked") - number(occlusion, "exchanges_blocked");
        assert!(missing >= unblocked && (unblocked > 0.0 || pass > 0));
        let least = [10.0, 1.0][pass];
        assert!(number(visibility, "full_visibility_percent") > least);
        // A rare occlusion may cost more rays to look for than it saves: only together must proofs save rays.
        assert!(number(occlusion, "rays") < number(normal, "rays"));
        assert!(number(blockers, "rays") < number(normal, "rays"));
        assert_eq!(number(unoccluded, "rays"), 0.0);
        assert_eq!(number(normal, "speedup"), 1.0);
    }
    let json: serde_json::Value =
        serde_json::from_slice(&fs::read(folder.path("t.json")).unwrap()).unwrap();
    assert_eq!(
        json["rows"][0]["seconds"]["all"].as_array().unwrap().len(),
        2
    );
    assert!(
        fs::read_to_string(folder.path("t.md"))
            .unwrap()
            .contains("| cornell | 1 | normal |")
    );
}

#[test]
fn a_scene_that_is_not_there_is_named() {
    let run = Folder::new().line("compare builtin:nowhere");
    run.ends_with(2, "nowhere");
    assert!(run.stderr.contains("nowhere"), "{}", run.stderr);
}

#[test]
fn a_baseline_that_is_none_is_refused_before_the_suite_runs() {
    let folder = Folder::new();
    for (name, text) in [("empty.json", ""), ("other.json", "{\"format\": 1}")] {
        fs::write(folder.path(name), text).unwrap();
        let run = folder.line(&format!("bench --check {name}"));
        run.ends_with(2, name);
        assert!(run.stderr.contains(name), "{}", run.stderr);
    }
    folder
        .line("bench --check missing.json")
        .ends_with(2, "missing");
}

/// Flags of a solve that mean nothing to a comparison are not passed over in silence.
#[test]
fn flags_that_are_not_used_are_said() {
    let folder = Folder::new();
    let line =
        "compare builtin:cornell --repeat 1 --passes 1 --epsilon 1e-2 --techniques occlusion";
    let run = folder.line(line);
    run.ends_with(0, "plain");
    assert_eq!(run.stderr, "");
    // No later pass: no mean of later passes.
    let summary = run.stdout.lines().rev().find(|l| l.contains("occlusion"));
    assert!(summary.unwrap().contains("| - |"), "{}", run.stdout);
    for (flag, word) in [
        ("--technique normal", "--techniques"),
        ("--quality draft --technique blockers", "--techniques"),
    ] {
        let run = folder.line(&format!("{line} {flag}"));
        run.ends_with(0, flag).says(&["warning", word]);
    }
    folder
        .line(&format!(
            "{} --converge 0.5",
            line.replace(" --passes 1", "")
        ))
        .ends_with(0, "converge")
        .says(&["warning", "--converge is not used"]);
    folder
        .line(&format!("{line} --check-claims"))
        .ends_with(2, "check")
        .says(&["--check-claims"]);
    folder
        .line("audit builtin:cornell --epsilon 1e-2 --technique normal")
        .ends_with(0, "audit")
        .says(&["--technique normal proves nothing"]);
}
