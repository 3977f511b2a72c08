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
    for row in json["rows"].as_array().unwrap() {
        let counts = row["counts"].as_object().unwrap();
        assert!(counts["exchanges"].as_u64().unwrap() > 0);
        assert!(!counts.contains_key("seconds") && !counts.contains_key("unshot"));
    }
    // No rays are no number of times fewer; blockers may need none either.
    let casts_none = |technique: &serde_json::Value| {
        let mut rows = json["rows"].as_array().unwrap().iter();
        rows.any(|row| row["technique"] == *technique && row["counts"]["rays"] == 0)
    };
    let summary = json["summary"].as_array().unwrap();
    assert_eq!(summary.len(), names.len() - 1);
    for row in summary {
        let is_left_out = row.get("fewer_rays").is_none();
        assert_eq!(is_left_out, casts_none(&row["technique"]), "{row}");
    }
    let table = fs::read_to_string(folder.path("t.md")).unwrap();
    assert!(table.contains("| cornell | 1 | normal |"));
    let last = table.lines().rfind(|line| line.contains("unoccluded"));
    assert!(last.unwrap().ends_with("| - |"), "{table}");
    folder
        .line("report . --out report.html")
        .ends_with(0, "a report without the number");
}

/// What is asked for is printed; what is quiet is the progress.
#[test]
fn the_table_is_no_progress() {
    let folder = Folder::new();
    let run = folder.line("compare builtin:cornell --epsilon 1e-2 --passes 1 --repeat 1 --quiet");
    run.ends_with(0, "compare");
    assert!(
        run.stdout.contains("| cornell | 1 | normal |"),
        "{}",
        run.stdout
    );
    let run = folder.line("audit builtin:cornell --epsilon 1e-2 --claims 10 --detection -q");
    run.ends_with(0, "audit");
    for words in [
        "claims audited",
        "visibility claims tested against every polygon",
        "contradictions that stand: 0",
        "pass  exchanges",
    ] {
        assert!(run.stdout.contains(words), "{}", run.stdout);
    }
}

/// A machine without valgrind records all but instructions, and checks against what it recorded.
#[test]
fn a_baseline_needs_no_instructions() {
    let folder = Folder::new();
    let line = "bench --suite smoke --no-instructions --quiet";
    folder
        .line(&format!("{line} --record b.json"))
        .ends_with(0, "record");
    let text = fs::read_to_string(folder.path("b.json")).unwrap();
    assert!(!text.contains("instructions"), "{text}");
    // Times are not what is tested: no run is as slow as this.
    let mut other: serde_json::Value = serde_json::from_str(&text).unwrap();
    for row in other["rows"].as_array_mut().unwrap() {
        row["ratio"] = 1.0e6.into();
    }
    folder.write("slow.json", other.to_string());
    folder
        .line(&format!("{line} --check slow.json"))
        .ends_with(0, "check");
    // A count that differs is a regression, whose report says all that was checked.
    other["rows"][0]["counts"]["rays"] = 1.into();
    folder.write("other.json", other.to_string());
    folder
        .line(&format!("{line} --check other.json"))
        .ends_with(1, "regression")
        .says(&["1 regressions", "counts exactly", "time ratios within"]);
    let run = folder.line("bench --suite ci --no-instructions --check b.json");
    run.ends_with(2, "another suite")
        .says(&["--suite smoke", "--suite ci"]);
    assert_eq!(run.stdout, "", "nothing has run");
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
