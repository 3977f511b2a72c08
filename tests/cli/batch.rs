//! Many solves from a list.
#![cfg(unix)]

use crate::command::{Folder, Outcome, ROOM, write_room};
use crate::determinism::counts;
use rustix::process::{Pid, Signal, kill_process};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::thread::sleep;
use std::time::{Duration, Instant, SystemTime};

const DEFAULTS: &str = "[defaults]\nno-view = true\nepsilon = 1e-3\ngradient = 0.1\n";

fn batch(folder: &Folder) -> Value {
    let text = fs::read_to_string(folder.path("out/batch.json")).unwrap();
    serde_json::from_str(&text).unwrap()
}

/// Status of each job.
fn statuses(folder: &Folder) -> BTreeMap<String, String> {
    let file = batch(folder);
    let jobs = file["jobs"].as_array().unwrap();
    let text = |v: &Value| v.as_str().unwrap().to_owned();
    let statuses: BTreeMap<_, _> = jobs
        .iter()
        .map(|job| (text(&job["name"]), text(&job["status"])))
        .collect();
    assert_eq!(statuses.len(), jobs.len());
    assert_eq!(file["counts"]["total"], jobs.len());
    statuses
}

fn want(pairs: &[(&str, &str)]) -> BTreeMap<String, String> {
    let own = |&(k, v): &(&str, &str)| (k.to_owned(), v.to_owned());
    pairs.iter().map(own).collect()
}

fn with_scenes(names: &[&str]) -> Folder {
    let folder = Folder::new();
    fs::create_dir(folder.path("scenes")).unwrap();
    for name in names {
        folder.write(&format!("scenes/{name}.obj"), ROOM[0]);
    }
    folder.write("scenes/room.mtl", ROOM[1]);
    folder
}

#[test]
fn patterns_grids_and_failures_together() {
    let folder = with_scenes(&["hall-a", "hall-b", "kitchen", "bad"]);
    folder.write(
        "scenes/bad.obj",
        "mtllib room.mtl\nusemtl wall\nv 0 0 0\nf 1 2 3\n",
    );
    folder.write(
        "jobs.toml",
        format!(
            "{DEFAULTS}
[[job]]
scene = \"scenes/hall-*.obj\"
technique = \"normal\"
[job.grid]
epsilon = [1e-3, 2e-3]
passes = [1, 2]

[[job]]
scene = \"scenes/bad.obj\"

[[job]]
scene = \"scenes/missing.obj\"

[[job]]
name = \"last\"
scene = \"scenes/kitchen.obj\"
passes = 3
"
        ),
    );
    let run = folder.line("batch jobs.toml --out out --jobs 2 --threads 2");
    run.ends_with(1, "batch").says(&[
        "2 of 11 jobs failed",
        "bad: ",
        "missing: ",
        "vertex",
        "exit code 2",
    ]);
    let mut all = want(&[("bad", "failed"), ("missing", "failed"), ("last", "done")]);
    for scene in ["hall-a", "hall-b"] {
        for epsilon in ["1e-3", "2e-3"] {
            for passes in [1, 2] {
                let name = format!("{scene}-epsilon={epsilon}-passes={passes}");
                let stats = folder.stats(&format!("out/{name}"));
                assert_eq!(stats["passes"].as_array().unwrap().len(), passes);
                assert_eq!(stats["epsilon"], epsilon.parse::<f64>().unwrap());
                assert_eq!(stats["technique"], "normal");
                assert_eq!(stats["threads"], 1);
                all.insert(name, "done".to_owned());
            }
        }
    }
    assert_eq!(statuses(&folder), all);
    assert_eq!(folder.stats("out/last")["technique"], "occlusion");
    let file = batch(&folder);
    assert_eq!(file["finished"], true);
    assert_eq!(file["counts"]["failed"], 2);
    let bad = file["jobs"]
        .as_array()
        .unwrap()
        .iter()
        .find(|j| j["name"] == "bad")
        .unwrap();
    assert_eq!(bad["exit_code"], 2);
    assert!(bad["error"].as_str().unwrap().contains("bad.obj"));
    // What a job writes is what the same solve writes by itself.
    folder
        .line("solve scenes/kitchen.obj --no-view --epsilon 1e-3 --gradient 0.1 --passes 3 --out alone")
        .ends_with(0, "alone");
    let solution = |name: &str| fs::read(folder.path(name).join("solution.ply")).unwrap();
    assert!(solution("alone") == solution("out/last"));

    // Again: only what failed, what was changed and what was cut is solved.
    let stamp = |name: &str| {
        fs::metadata(folder.path(format!("out/{name}/stats.json")))
            .unwrap()
            .modified()
            .unwrap()
    };
    let before = stamp("last");
    folder.write("scenes/bad.obj", ROOM[0]);
    folder.write(
        "scenes/hall-b.obj",
        ROOM[0].replace("v 1 1 1\n", "v 1 1 1.01\n"),
    );
    let list = fs::read_to_string(folder.path("jobs.toml")).unwrap();
    folder.write(
        "jobs.toml",
        list.replace("scenes/missing", "scenes/hall-a").replace(
            "scene = \"scenes/hall-a.obj\"",
            "name = \"missing\"\nscene = \"scenes/hall-a.obj\"",
        ),
    );
    let run = folder.line("batch jobs.toml --out out --jobs 2 --resume");
    run.ends_with(0, "again");
    let again = statuses(&folder);
    for (name, status) in &again {
        let solved = name.starts_with("hall-b") || ["bad", "missing"].contains(&name.as_str());
        assert_eq!(status, if solved { "done" } else { "skipped" }, "{name}");
    }
    assert_eq!(stamp("last"), before);
    assert!(
        run.stdout.contains("6 done, 5 skipped, 0 failed"),
        "{}",
        run.stdout
    );

    // Other pictures are other work, though no other light.
    let list = fs::read_to_string(folder.path("jobs.toml")).unwrap();
    folder.write(
        "jobs.toml",
        list.replace("no-view = true", "format = \"vtu\""),
    );
    let light = fs::read(folder.path("out/last/solution.ply")).unwrap();
    folder
        .line("batch jobs.toml --out out --resume --only last")
        .ends_with(0, "other outputs");
    for name in ["view.png", "view.exr", "solution.vtu"] {
        assert!(folder.path(format!("out/last/{name}")).exists(), "{name}");
    }
    assert!(light == fs::read(folder.path("out/last/solution.ply")).unwrap());

    // Other settings are another solve, and the list says that it belongs into the folder.
    let list = fs::read_to_string(folder.path("jobs.toml")).unwrap();
    folder.write("jobs.toml", list.replace("passes = 3", "passes = 2"));
    folder
        .line("batch jobs.toml --out out --resume --only last")
        .ends_with(0, "other settings");
    let passes = &folder.stats("out/last")["passes"];
    assert_eq!(passes.as_array().unwrap().len(), 2);
}

#[test]
fn lists_that_cannot_be_used_run_nothing() {
    let folder = with_scenes(&["a", "b"]);
    let job = "[[job]]\nscene = \"scenes/a.obj\"\n";
    for (what, list, words) in [
        ("toml", "[defaults]\nepsilon = = 1\n", ":2: "),
        ("toml", "[[job]\n", ":1: "),
        ("empty", "", "lists no job"),
        ("no job", "[defaults]\nepsilon = 1e-3\n", "lists no job"),
        (
            "key",
            &format!("{job}epsilom = 1e-3\n"),
            ":3: unknown key `epsilom`; did you mean `epsilon`?",
        ),
        ("key", &format!("{job}min_area = 1e-3\n"), "`min-area`"),
        (
            "key",
            &format!("[default]\nepsilon = 1\n{job}"),
            ":1: unknown key `default`; did you mean `defaults`?",
        ),
        (
            "key",
            &format!("[[jobs]]\n{job}"),
            ":1: unknown key `jobs`; did you mean `job`?",
        ),
        ("key", &format!("{job}scenes = \"x\"\n"), "`scene`"),
        ("key", &format!("{job}out = \"x\"\n"), "unknown key `out`"),
        (
            "place",
            &format!("epsilon = 1e-3\n{job}"),
            ":1: `epsilon` belongs under [defaults]",
        ),
        (
            "value",
            &format!("{job}epsilon = -1\n"),
            ":3: `epsilon`: --epsilon must be",
        ),
        (
            "value",
            &format!("{job}epsilon = nan\n"),
            "--epsilon must be",
        ),
        (
            "value",
            &format!("{job}epsilon = \"fine\"\n"),
            ":3: `epsilon`: invalid value 'fine'",
        ),
        (
            "value",
            &format!("{job}epsilon = true\n"),
            ":3: `epsilon`: a single value is needed",
        ),
        (
            "value",
            &format!("{job}no-view = 1\n"),
            ":3: `no-view`: true or false is needed",
        ),
        (
            "value",
            &format!("{job}technique = \"oclusion\"\n"),
            "possible values",
        ),
        (
            "value",
            &format!("{job}rays = 8.5\n"),
            ":3: `rays`: invalid value",
        ),
        (
            "value",
            &format!("{job}technique = [\"normal\"]\n"),
            "not a list",
        ),
        (
            "conflict",
            &format!("{job}passes = 1\nconverge = 0.1\n"),
            "cannot be used with",
        ),
        (
            "grid",
            &format!("{job}[job.grid]\nepsilon = 1e-3\n"),
            ":4: `epsilon`: a grid needs a list",
        ),
        ("grid", &format!("{job}[job.grid]\nepsilon = []\n"), "empty"),
        (
            "grid",
            &format!("{job}[job.grid]\nepsilon = [1e-3, -2]\n"),
            ":4: `epsilon`: --epsilon",
        ),
        (
            "grid",
            &format!("{job}[job.grid]\nepsilom = [1e-3]\n"),
            "`epsilon`",
        ),
        (
            "scene",
            "[[job]]\nname = \"x\"\n",
            ":1: the job has no `scene`",
        ),
        ("scene", "[[job]]\nscene = 3\n", ":2: `scene` is a text"),
        (
            "scene",
            "[[job]]\nscene = \"scenes/z*.obj\"\n",
            ":2: no file matches",
        ),
        (
            "scene",
            "[[job]]\nscene = \"scenes/[a.obj\"\n",
            ":2: the pattern",
        ),
        ("scene", "[[job]]\nscene = []\n", "`scene`"),
        ("name", &format!("{job}name = \"../x\"\n"), "may not"),
        ("name", &format!("{job}name = \"\"\n"), "needs a name"),
        ("name", &format!("{job}name = \".\"\n"), "dot"),
        (
            "twice",
            &format!("{job}\n{job}"),
            "two jobs are called \"a\": of line 1",
        ),
        (
            "twice",
            "[[job]]\nname = \"n\"\nscene = \"scenes/a.obj\"\n[[job]]\nname = \"n\"\nscene = \"scenes/b.obj\"\n",
            "two jobs are called \"n\"",
        ),
        (
            "twice",
            &format!("{job}[job.grid]\nepsilon = [1e-3, 1e-3]\n"),
            "two jobs",
        ),
        ("job", "job = 3\n", "[[job]]"),
        ("defaults", &format!("defaults = 3\n{job}"), "[defaults]"),
    ] {
        folder.write("jobs.toml", list);
        let run = folder.line("batch jobs.toml --out out");
        run.ends_with(2, &format!("{what}: {list}"))
            .says(&["jobs.toml", words]);
        assert!(!folder.path("out").exists(), "{what}: {list}");
    }
    folder.write("jobs.toml", b"[[job]]\nscene = \"\xff\"\n");
    folder
        .line("batch jobs.toml --out out")
        .ends_with(2, "bytes")
        .says(&[":2: is not UTF-8"]);
    folder
        .line("batch missing.toml --out out")
        .ends_with(2, "missing")
        .says(&["missing.toml"]);
    folder
        .line("batch scenes --out out")
        .ends_with(2, "folder")
        .says(&["regular file"]);
}

/// A list of slow jobs.
fn slow(folder: &Folder) {
    folder.write(
        "jobs.toml",
        "[defaults]
no-view = true
epsilon = 1e-5
gradient = 0.01
converge = 1e-30
[[job]]
name = \"a\"
scene = \"room.obj\"
[[job]]
name = \"b\"
scene = \"room.obj\"
seed = 2
[[job]]
name = \"c\"
scene = \"room.obj\"
seed = 3
",
    );
    write_room(folder);
}

fn checkpoint_time(folder: &Folder) -> Option<SystemTime> {
    let found = fs::metadata(folder.path("out/a/solve.checkpoint")).ok()?;
    Some(found.modified().unwrap())
}

/// Starts the slow batch and waits until its first job has made a checkpoint.
fn begun(folder: &Folder, line: &str) -> std::process::Child {
    let words: Vec<&str> = line.split_whitespace().collect();
    let before = checkpoint_time(folder);
    let mut child = folder.command(&words).spawn().unwrap();
    let began = Instant::now();
    while checkpoint_time(folder).is_none_or(|time| Some(time) == before) {
        assert!(child.try_wait().unwrap().is_none(), "it ended by itself");
        assert!(began.elapsed() < Duration::from_secs(60), "no checkpoint");
        sleep(Duration::from_millis(1));
    }
    child
}

#[test]
fn a_stopped_batch_goes_on_where_it_was() {
    let folder = Folder::new();
    slow(&folder);
    let line = "batch jobs.toml --out out --jobs 1";
    for (signal, words) in [(Signal::INT, "--resume"), (Signal::TERM, "--resume")] {
        let child = begun(&folder, &format!("{line} --resume"));
        kill_process(Pid::from_child(&child), signal).unwrap();
        let run = Outcome::of(child.wait_with_output().unwrap());
        run.ends_with(130, "stopped").says(&["interrupted", words]);
        let want = want(&[("a", "interrupted"), ("b", "waiting"), ("c", "waiting")]);
        assert_eq!(statuses(&folder), want);
        let file = fs::read(folder.path("out/batch.json")).unwrap();
        let file: serde_json::Value = serde_json::from_slice(&file).unwrap();
        assert_eq!(file["finished"], false);
        assert!(folder.path("out/a/solve.checkpoint").exists());
        assert!(!folder.path("out/b").exists());
    }
    // Killed, it takes its jobs with it, and whatever it left is taken up.
    let mut child = begun(&folder, &format!("{line} --resume"));
    child.kill().unwrap();
    child.wait().unwrap();
    sleep(Duration::from_millis(200));
    let before = checkpoint_time(&folder);
    sleep(Duration::from_millis(500));
    assert_eq!(
        checkpoint_time(&folder),
        before,
        "the job outlived its batch"
    );

    folder
        .line(&format!("{line} --resume"))
        .ends_with(0, "to the end");
    assert_eq!(
        statuses(&folder),
        want(&[("a", "done"), ("b", "done"), ("c", "done")])
    );
    let log = fs::read_to_string(folder.path("out/a/log.txt")).unwrap();
    assert!(log.contains("interrupted in pass"), "{log}");
    folder
        .line(
            "solve room.obj --no-view --epsilon 1e-5 --gradient 0.01 --converge 1e-30 --out alone",
        )
        .ends_with(0, "alone");
    let solution = |name: &str| fs::read(folder.path(name).join("solution.ply")).unwrap();
    assert!(solution("alone") == solution("out/a"));
    assert_eq!(counts(folder.stats("alone")), counts(folder.stats("out/a")));
}

#[test]
fn jobs_can_be_run_one_by_one_for_other_schedulers() {
    let folder = with_scenes(&["a", "b"]);
    folder.write(
        "jobs.toml",
        format!("{DEFAULTS}[[job]]\nscene = \"scenes/?.obj\"\n"),
    );
    let names = folder.line("batch jobs.toml --out out --list-names");
    names.ends_with(0, "names");
    assert_eq!(names.stdout, "a\nb\n");
    assert!(!folder.path("out").exists());
    folder
        .line("batch jobs.toml --out out --resume --only b")
        .ends_with(0, "one");
    assert_eq!(folder.names("out"), ["b"]);
    folder
        .line("batch jobs.toml --out out --only bb")
        .ends_with(2, "none")
        .says(&["no job", "\"b\""]);
    folder
        .line("batch jobs.toml --out out --resume")
        .ends_with(0, "collected");
    assert_eq!(statuses(&folder), want(&[("a", "done"), ("b", "skipped")]));
}

#[test]
fn the_configuration_file_is_below_the_list() {
    let folder = with_scenes(&["a"]);
    folder.write(
        "certilux.toml",
        "[solve]\nseed = 7\nepsilon = 5e-3\npasses = 2\n",
    );
    folder.write(
        "jobs.toml",
        format!("{DEFAULTS}converge = 0.5\n[[job]]\nscene = \"scenes/a.obj\"\n"),
    );
    folder
        .line("batch jobs.toml --out out")
        .ends_with(0, "batch");
    let stats = folder.stats("out/a");
    assert_eq!(stats["seed"], 7);
    assert_eq!(stats["epsilon"], 1e-3);
    assert_eq!(stats["settings"]["converge"], "5e-1");
    folder
        .line("batch jobs.toml --out out --no-config")
        .ends_with(0, "plain");
    assert_eq!(folder.stats("out/a")["seed"], 1);
}
