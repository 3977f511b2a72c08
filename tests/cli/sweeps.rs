//! `sweep`: the table's columns are a contract, its figures are those of `solve` and `error`, and an interrupted
//! sweep goes on.

use crate::command::{Folder, Outcome, write_room};
use serde_json::Value;
use std::fs;
use std::io::BufReader;

const COLUMNS: &str = "scene,technique,epsilon,rays_per_exchange,stride,occluders_per_cluster,occluder_size,flatness,gradient,\
min_area,converge,quality,repeats,seconds,processor_seconds,passes,exchanges,exchanges_blocked,exchanges_visible,rays,\
rays_blocked,native_rays,shafts,occluders,leaves,relative_rms,bias,reference_noise,imbalance,unshot,front_seconds,front_rays";

const FILES: [&str; 7] = [
    "error-rays.png",
    "error-rays.svg",
    "error-seconds.png",
    "error-seconds.svg",
    "reference.json",
    "sweep.csv",
    "sweep.json",
];

/// A grid of six rows that takes a second or two.
const GRID: &str = "--technique normal,occlusion,unoccluded --epsilon 3e-3,1e-3 --rays 8 --gradient 0.1 --min-area 1e-3 \
--stride auto --occluders 8 --occluder-size 1e-4 --flatness 1 --converge 1e-2";

fn table(folder: &Folder, results: &str) -> Vec<Vec<String>> {
    let csv = fs::read_to_string(folder.path(results).join("sweep.csv")).unwrap();
    let mut lines = csv.lines();
    assert_eq!(lines.next(), Some(COLUMNS));
    let rows: Vec<Vec<String>> = lines
        .map(|l| l.split(',').map(str::to_owned).collect())
        .collect();
    let width = COLUMNS.split(',').count();
    assert!(!rows.is_empty() && rows.iter().all(|row| row.len() == width));
    rows
}

fn at(column: &str) -> usize {
    COLUMNS.split(',').position(|c| c == column).unwrap()
}

fn number(row: &[String], column: &str) -> f64 {
    row[at(column)].parse().unwrap()
}

fn json(folder: &Folder, path: &str) -> Value {
    serde_json::from_slice(&fs::read(folder.path(path)).unwrap()).unwrap()
}

fn measured(folder: &Folder) {
    write_room(folder);
    folder
        .line("reference room.obj --out ref.json --error 0.01")
        .ends_with(0, "reference");
}

fn swept(folder: &Folder, more: &str) -> Outcome {
    folder.line(&format!(
        "sweep room.obj --out results --reference ref.json {more}"
    ))
}

#[test]
fn a_row_a_setting_and_plots_that_open() {
    let folder = Folder::new();
    measured(&folder);
    swept(&folder, &format!("{GRID} --repeat 2")).ends_with(0, "sweep");
    let rows = table(&folder, "results");
    // 3 techniques x 2 epsilons; the lists without the default move the centre, which is among them.
    assert_eq!(rows.len(), 6);
    let texts = ["scene", "technique", "stride", "quality"];
    for row in &rows {
        for (column, cell) in COLUMNS.split(',').zip(row) {
            let finite = cell.parse::<f64>().is_ok_and(f64::is_finite);
            assert!(texts.contains(&column) || finite, "{column}: {cell}");
        }
        assert_eq!(row[0], "room.obj");
        assert_eq!(number(row, "repeats"), 2.0);
        for positive in [
            "seconds",
            "processor_seconds",
            "exchanges",
            "leaves",
            "relative_rms",
        ] {
            assert!(number(row, positive) > 0.0, "{positive}");
        }
    }
    // Fronts as their definition says, from the table's own figures.
    for (column, cost) in [
        ("front_seconds", "processor_seconds"),
        ("front_rays", "rays"),
    ] {
        let lights = |row: &&Vec<String>| row[at("technique")] != "unoccluded";
        for row in &rows {
            let beaten = rows.iter().filter(lights).any(|other| {
                let (c, e) = (number(other, cost), number(other, "relative_rms"));
                let (cost, error) = (number(row, cost), number(row, "relative_rms"));
                c <= cost && e <= error && (c < cost || e < error)
            });
            let on = lights(&row) && !beaten;
            assert_eq!(number(row, column), f64::from(u8::from(on)), "{column}");
        }
    }
    let kept = json(&folder, "results/sweep.json");
    assert_eq!(kept["rows"].as_array().unwrap().len(), 6);
    assert_eq!(kept["rows"][0]["timings"].as_array().unwrap().len(), 2);
    // `reference.json` is not there: one was named.
    let names = folder.names("results");
    assert_eq!(
        names,
        FILES
            .iter()
            .filter(|n| **n != "reference.json")
            .copied()
            .collect::<Vec<_>>()
    );
    for (name, dots) in [("error-seconds", 6), ("error-rays", 4)] {
        let svg = fs::read_to_string(folder.path(format!("results/{name}.svg"))).unwrap();
        let document = roxmltree::Document::parse(&svg).unwrap();
        let circles = |radius: &str| {
            (document.descendants())
                .filter(|n| n.has_tag_name("circle") && n.attribute("r") == Some(radius))
                .count()
        };
        assert_eq!(circles("4"), dots, "{name}: a dot a row");
        let front = rows.iter().filter(|row| {
            number(
                row,
                if name == "error-rays" {
                    "front_rays"
                } else {
                    "front_seconds"
                },
            ) == 1.0
        });
        // And one ring in the legend.
        assert_eq!(
            circles("7"),
            front.count() + 1,
            "{name}: a ring a row of the front"
        );
        let png = fs::File::open(folder.path(format!("results/{name}.png"))).unwrap();
        let mut reader = png::Decoder::new(BufReader::new(png)).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut pixels).unwrap();
        assert_eq!((info.width, info.height), (1200, 800));
        let distinct: std::collections::BTreeSet<&[u8]> = pixels.chunks(3).collect();
        assert!(distinct.len() > 20, "text and dots have many shades");
    }
}

/// What a row says is what `solve` and `error` say at its settings, figure by figure.
#[test]
fn rows_are_what_solve_and_error_find() {
    let folder = Folder::new();
    measured(&folder);
    swept(&folder, &format!("{GRID} --repeat 1")).ends_with(0, "sweep");
    for row in table(&folder, "results") {
        let settings: Vec<String> = [
            ("--technique", "technique"),
            ("--epsilon", "epsilon"),
            ("--gradient", "gradient"),
            ("--min-area", "min_area"),
            ("--converge", "converge"),
        ]
        .iter()
        .map(|(flag, column)| format!("{flag} {}", row[at(column)]))
        .collect();
        folder
            .line(&format!(
                "solve room.obj --out solved --no-view {}",
                settings.join(" ")
            ))
            .ends_with(0, "solve");
        folder
            .line("error solved ref.json --json error.json")
            .ends_with(0, "error");
        let error = json(&folder, "error.json");
        let stats = folder.stats("solved");
        for (column, value) in [
            ("relative_rms", &error["relative_rms"]),
            ("bias", &error["bias"]),
            ("reference_noise", &error["noise"]),
            ("imbalance", &stats["power"]["imbalance"]),
        ] {
            let value = value.as_f64().unwrap();
            // Eight digits are printed.
            assert!(
                (number(&row, column) - value).abs() < 1.0e-8,
                "{column}: {value}"
            );
        }
        let passes = stats["passes"].as_array().unwrap();
        for column in ["rays", "exchanges", "shafts"] {
            let sum: f64 = passes.iter().map(|p| p[column].as_f64().unwrap()).sum();
            assert_eq!(number(&row, column), sum, "{column}");
        }
    }
}

#[test]
fn a_sweep_measures_its_own_reference_and_goes_on() {
    let folder = Folder::new();
    write_room(&folder);
    let sweep = |more: &str| {
        folder.line(&format!(
            "sweep room.obj --out results --reference-error 0.05 --technique normal --rays 8 --gradient 0.1 --min-area 1e-3 \
             --stride auto --occluders 8 --occluder-size 1e-4 --flatness 1 --converge 1e-2 {more}"
        ))
    };
    sweep("--repeat 1 --epsilon 3e-3,1e-3").ends_with(0, "sweep");
    assert_eq!(folder.names("results"), FILES);
    let before = json(&folder, "results/sweep.json");
    let reference = fs::read(folder.path("results/reference.json")).unwrap();
    sweep("--repeat 1 --epsilon 1e-3,2e-3 --resume").ends_with(0, "resume");
    let after = json(&folder, "results/sweep.json");
    let row = |table: &Value, epsilon: f64| {
        let rows = table["rows"].as_array().unwrap();
        let mut found = rows.iter().filter(|r| r["settings"]["epsilon"] == epsilon);
        let row = found
            .next()
            .unwrap_or_else(|| panic!("{epsilon} is missing"))
            .clone();
        assert!(found.next().is_none());
        row
    };
    assert_eq!(after["rows"].as_array().unwrap().len(), 3);
    for epsilon in [3e-3, 1e-3] {
        let (before, after) = (row(&before, epsilon), row(&after, epsilon));
        assert_eq!(before["timings"], after["timings"], "not solved again");
        assert_eq!(before["outcome"], after["outcome"]);
    }
    assert_eq!(row(&after, 2e-3)["timings"].as_array().unwrap().len(), 1);
    let now = fs::read(folder.path("results/reference.json")).unwrap();
    assert!(reference == now, "the reference is kept");

    // A reference that rows were compared with stays, and says so where another was asked for.
    let finer = |resume: &str| {
        folder.line(&format!(
            "sweep room.obj --out results --reference-error 0.04 --technique normal --rays 8 --gradient 0.1 --min-area 1e-3 \
             --stride auto --occluders 8 --occluder-size 1e-4 --flatness 1 --converge 1e-2 --repeat 1 --epsilon 3e-3 {resume}"
        ))
    };
    finer("--resume").ends_with(0, "another reference").says(&[
        "reference.json is kept",
        "0.05",
        "not a standard error of 0.04",
    ]);
    let kept = fs::read(folder.path("results/reference.json")).unwrap();
    assert!(reference == kept, "the reference is kept");
    // One that no row knows serves only if it is the one asked for.
    let good = fs::read_to_string(folder.path("results/sweep.json")).unwrap();
    fs::remove_file(folder.path("results/sweep.json")).unwrap();
    sweep("--repeat 1 --epsilon 3e-3 --resume").ends_with(0, "no rows");
    let kept = fs::read(folder.path("results/reference.json")).unwrap();
    assert!(reference == kept, "the reference is kept");
    fs::remove_file(folder.path("results/sweep.json")).unwrap();
    let run = finer("--resume");
    run.ends_with(0, "a new reference");
    assert_eq!(run.stderr, "");
    let meta = json(&folder, "results/reference.json")["meta"].clone();
    assert_eq!(meta["error"], 0.04);
    folder.write("results/reference.json", &reference);
    folder.write("results/sweep.json", &good);

    // What is of another sweep, cut or no sweep at all is refused and left alone.
    let threads = "\"threads\": ";
    for bad in [
        String::new(),
        "{}".to_owned(),
        good[..good.len() / 2].to_owned(),
        good.replace(threads, "\"threads\": 9"),
        good.replace("\"rays\": 8,", "\"rays\": -8,"),
        good.replace("\"normal\"", "\"magic\""),
    ] {
        assert_ne!(bad, good);
        folder.write("results/sweep.json", &bad);
        let ended = sweep("--repeat 1 --epsilon 1e-3 --resume");
        ended.ends_with(2, "a bad table").says(&["sweep.json"]);
        if bad.contains("\"threads\": 9") {
            ended.says(&["another sweep: threads is 9"]);
        }
        assert_eq!(
            fs::read(folder.path("results/sweep.json")).unwrap(),
            bad.as_bytes()
        );
    }
}

#[test]
fn settings_out_of_range_end_with_two_before_anything_is_written() {
    let folder = Folder::new();
    write_room(&folder);
    for flags in [
        "--epsilon 0",
        "--epsilon 1e-3,-1",
        "--epsilon 1e-3,nan",
        "--epsilon=",
        "--epsilon 1e-3,,1e-4",
        "--rays 0",
        "--rays 8,1048577",
        "--rays 2.5",
        "--stride 0",
        "--stride auto,sometimes",
        "--flatness 31",
        "--occluder-size 0",
        "--occluders -1",
        "--gradient inf",
        "--min-area -1",
        "--converge 0",
        "--technique normal,magic",
        "--repeat 0",
        "--repeat 1.5",
        "--reference-error 0",
        "--reference-seconds nan",
        "--reference missing.json",
        "--reference room.obj",
        "--threads 1000000",
    ] {
        let line = format!("sweep room.obj --out results --quick {flags}");
        folder.line(&line).ends_with(2, &line);
    }
    let many: Vec<String> = (1..=200).map(|n| n.to_string()).collect();
    let many = many.join(",");
    let line = format!("sweep room.obj --out results --rays {many} --epsilon {many} --quick");
    folder
        .line(&line)
        .ends_with(2, "too many")
        .says(&["--cross"]);
    for scene in ["missing.obj", "builtin:nowhere"] {
        let line = format!("sweep {scene} --out results --quick");
        folder.line(&line).ends_with(2, &line);
    }
    assert_eq!(folder.names("."), ["room.mtl", "room.obj"]);
}

#[test]
fn a_reference_of_another_scene_is_refused() {
    let folder = Folder::new();
    write_room(&folder);
    folder
        .line("reference builtin:cornell --out ref.json --error 0.5 --max-seconds 1")
        .ends_with(0, "reference");
    swept(&folder, "--quick")
        .ends_with(2, "ref.json")
        .says(&["face"]);
    assert!(folder.names("results").is_empty());
}

#[test]
fn a_folder_that_cannot_be_made_is_told_before_the_work() {
    let folder = Folder::new();
    write_room(&folder);
    folder.write("taken", "keep me");
    folder
        .line("sweep room.obj --out taken --quick")
        .ends_with(3, "taken")
        .says(&["taken"]);
    assert_eq!(fs::read(folder.path("taken")).unwrap(), b"keep me");
}

#[test]
fn presets_give_what_no_flag_does() {
    let folder = Folder::new();
    write_room(&folder);
    let solved = |flags: &str| {
        let line =
            format!("solve room.obj --out solved --no-view --gradient 0.1 --min-area 1e-2 {flags}");
        folder.line(&line).ends_with(0, &line);
        (
            folder.stats("solved"),
            fs::read(folder.path("solved/solution.ply")).unwrap(),
        )
    };
    let (plain, solution) = solved("");
    let (normal, same) = solved("--quality normal");
    assert!(solution == same, "normal is the default");
    assert_eq!(
        (&plain["quality"], &normal["quality"]),
        (&normal["quality"], &Value::from("normal"))
    );
    let (draft, _) = solved("--quality draft");
    assert_eq!(draft["quality"], "draft");
    let key = |stats: &Value, key: &str| stats[key].as_f64().unwrap();
    assert!(key(&draft, "epsilon") > key(&normal, "epsilon"));
    let (mixed, _) = solved("--quality high --epsilon 1e-3 --converge 0.1");
    assert_eq!(mixed["quality"], "high");
    assert_eq!(
        (key(&mixed, "epsilon"), key(&mixed, "converge")),
        (1e-3, 0.1)
    );
    folder
        .line("solve room.obj --out bad --quality best")
        .ends_with(2, "best")
        .says(&["draft", "normal", "high"]);
    assert!(folder.line("solve --help").stdout.contains("--quality"));
}

#[test]
fn an_error_budget_has_a_line_an_approximation() {
    let folder = Folder::new();
    write_room(&folder);
    folder
        .line("reference builtin:cornell --out ref.json --max-seconds 2")
        .ends_with(0, "reference");
    let run = folder.line(
        "error-budget builtin:cornell --reference ref.json --json budget.json --seeds 2 --quiet \
         --epsilon 1e-2 --gradient 0.1 --min-area 1e-3 --rays 4",
    );
    run.ends_with(0, "budget");
    let budget = json(&folder, "budget.json");
    let lines = budget["lines"].as_array().unwrap();
    assert_eq!(lines.len(), 7);
    let line = |name: &str| {
        let found = lines.iter().find(|l| l["approximation"] == name);
        found.unwrap_or_else(|| panic!("{name} is missing"))
    };
    let rms = |error: &Value| error["error"]["relative_rms"].as_f64().unwrap();
    // Proofs change no light; with everything nearly exact little error is left.
    assert_eq!(rms(line("proofs")), rms(&budget));
    assert!(rms(line("all")) < 0.75 * rms(&budget), "{budget}");
    let removed = line("all")["removed"].as_f64().unwrap();
    let left = (rms(line("all")) / rms(&budget)).powi(2);
    assert!((removed - (1.0 - left)).abs() < 1e-12);
    let chance = budget["chance"].as_f64().unwrap();
    assert!(chance > 0.0 && chance < 1.5, "{chance}");
    assert!(
        run.stdout.contains("| sampled visibility: rays x 16"),
        "{}",
        run.stdout
    );
    for line in [
        "error-budget room.obj",
        "error-budget room.obj --reference missing.json",
        "error-budget room.obj --reference room.obj",
        "error-budget room.obj --reference ref.json --seeds 1",
        "error-budget room.obj --reference ref.json --epsilon 0",
        "error-budget missing.obj --reference ref.json",
    ] {
        folder.line(line).ends_with(2, line);
    }
}
