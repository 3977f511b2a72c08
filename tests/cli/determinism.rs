//! The same input gives the same bytes: on any number of threads, from memory or from files.

use crate::command::Folder;
use certilux::output::read_ply;
use serde_json::Value;
use std::fs;

/// `stats.json` without what may differ between equal solves: seconds, threads and the words typed.
pub fn counts(mut stats: Value) -> Value {
    let tree = stats.as_object_mut().unwrap();
    for key in ["seconds", "threads", "command"] {
        tree.remove(key).unwrap();
    }
    for pass in tree["passes"].as_array_mut().unwrap() {
        pass.as_object_mut().unwrap().remove("seconds").unwrap();
    }
    stats
}

#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    let folder = Folder::new();
    for threads in ["1", "2", "3"] {
        let run = folder.line(&format!(
            "solve builtin:cornell --no-view --epsilon 1e-4 --out {threads} --threads {threads}"
        ));
        run.ends_with(0, threads);
        assert_eq!(folder.stats(threads)["threads"].to_string(), threads);
    }
    let solution = |name: &str| fs::read(folder.path(name).join("solution.ply")).unwrap();
    let first = counts(folder.stats("1"));
    assert!(first["passes"][0]["rays"].as_u64().unwrap() > 0);
    for threads in ["2", "3"] {
        assert!(solution("1") == solution(threads), "{threads} threads");
        assert_eq!(first, counts(folder.stats(threads)), "{threads} threads");
    }
}

#[test]
fn another_seed_gives_other_samples() {
    let folder = Folder::new();
    for seed in ["1", "2"] {
        folder
            .line(&format!(
                "solve builtin:cornell --no-view --passes 1 --epsilon 1e-3 --seed {seed} --out {seed}"
            ))
            .ends_with(0, seed);
    }
    let solution = |name: &str| fs::read(folder.path(name).join("solution.ply")).unwrap();
    assert!(solution("1") != solution("2"), "the seed has no effect");
}

#[test]
fn a_scene_written_as_files_solves_as_from_memory() {
    let folder = Folder::new();
    folder
        .line("generate cornell --out scenes")
        .ends_with(0, "generate");
    assert_eq!(folder.names("scenes"), ["cornell.mtl", "cornell.obj"]);
    for (scene, out) in [("builtin:cornell", "a"), ("scenes/cornell.obj", "b")] {
        folder
            .line(&format!(
                "solve {scene} --no-view --epsilon 1e-3 --out {out}"
            ))
            .ends_with(0, scene);
    }
    let solution = |name: &str| fs::read(folder.path(name).join("solution.ply")).unwrap();
    assert!(solution("a") == solution("b"));
}

/// Radiosity does not depend on the unit of length, and a power of two rounds nothing.
#[test]
fn units_of_length_do_not_matter() {
    let folder = Folder::new();
    folder
        .line("generate cornell --out .")
        .ends_with(0, "generate");
    let obj = fs::read_to_string(folder.path("cornell.obj")).unwrap();
    let scaled: String = obj
        .lines()
        .map(|line| match line.strip_prefix("v ") {
            Some(rest) => {
                let c: Vec<f64> = rest
                    .split_whitespace()
                    .map(|w| 8.0 * w.parse::<f64>().unwrap())
                    .collect();
                format!("v {:?} {:?} {:?}\n", c[0], c[1], c[2])
            }
            None => format!("{line}\n"),
        })
        .collect();
    assert_ne!(obj, scaled);
    folder.write("scaled.obj", scaled);
    for name in ["cornell", "scaled"] {
        folder
            .line(&format!(
                "solve {name}.obj --no-view --epsilon 1e-3 --out {name}"
            ))
            .ends_with(0, name);
    }
    let mesh = |name: &str| read_ply(&folder.path(name).join("solution.ply")).unwrap();
    let (one, eight) = (mesh("cornell"), mesh("scaled"));
    assert!(!one.faces.is_empty());
    assert!(one.faces == eight.faces, "the light differs");
    for (a, b) in one.vertices.iter().zip(&eight.vertices) {
        assert_eq!(*a * 8.0, *b);
    }
}
