//! The import rule, judged on a source tree.

use crate::paths::{absolute_paths, re_exports};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// What a tree was found to do.
#[derive(Debug, Default)]
pub struct Report {
    /// Files read.
    pub files: usize,
    /// Paths inside the crate that they name.
    pub imports: usize,
    /// What is against the rule, one line each.
    pub violations: Vec<String>,
}

/// A file of the tree: its module path and its text.
struct File {
    name: String,
    module: Vec<String>,
    is_folder: bool,
    text: String,
}

/// Edges between the children of each folder: folder -> child -> children it imports.
type Siblings = BTreeMap<Vec<String>, BTreeMap<String, BTreeSet<String>>>;

/// Judges the `.rs` files below `root`, folders being in `order`. `lib.rs` and `main.rs` stand
/// above all folders.
pub fn violations(root: &Path, order: &[&str]) -> Report {
    let files = read_tree(root);
    let modules: BTreeSet<&[String]> = files.iter().map(|f| f.module.as_slice()).collect();
    let handed_on: BTreeMap<&[String], BTreeMap<String, Vec<String>>> = files
        .iter()
        .filter(|file| file.is_folder)
        .map(|file| {
            (
                file.module.as_slice(),
                re_exports(&file.text).into_iter().collect(),
            )
        })
        .collect();

    let mut report = Report {
        files: files.len(),
        ..Report::default()
    };
    let mut siblings = Siblings::new();
    for file in &files {
        let Some(own) = order.iter().position(|folder| *folder == file.module[0]) else {
            report
                .violations
                .push(format!("{}: its folder is not in the order", file.name));
            continue;
        };
        for path in absolute_paths(&file.text, &file.module) {
            report.imports += 1;
            match order
                .iter()
                .position(|folder| path.first().is_some_and(|p| p == folder))
            {
                Some(other) if other < own => {}
                Some(other) if other == own => {
                    if let Err(problem) =
                        note_sibling(&file.module, &path, &modules, &handed_on, &mut siblings)
                    {
                        report.violations.push(format!("{}: {problem}", file.name));
                    }
                }
                Some(_) => report.violations.push(format!(
                    "{}: {} comes later",
                    file.name,
                    path.join("::")
                )),
                None => report.violations.push(format!(
                    "{}: {} is not in the order",
                    file.name,
                    path.join("::")
                )),
            }
        }
    }
    for (folder, edges) in &siblings {
        for cycle in cycles(edges) {
            report.violations.push(format!(
                "{}: cycle {}",
                folder.join("/"),
                cycle.join(" -> ")
            ));
        }
    }
    report
}

/// Notes which child of their common folder the file at `from` imports by `path`.
fn note_sibling(
    from: &[String],
    path: &[String],
    modules: &BTreeSet<&[String]>,
    handed_on: &BTreeMap<&[String], BTreeMap<String, Vec<String>>>,
    siblings: &mut Siblings,
) -> Result<(), String> {
    let common = from.iter().zip(path).take_while(|(a, b)| a == b).count();
    let (folder, Some(name)) = (&from[..common], path.get(common)) else {
        return Ok(());
    };
    // The folder's own mod.rs hands its children on; a file names what it defines itself.
    if from.len() == common {
        return Ok(());
    }
    let Some(names) = handed_on.get(folder) else {
        return Ok(());
    };
    if name == "*" {
        return Err(format!("{} hides what is imported", path.join("::")));
    }
    let child = if modules.contains(&path[..=common]) {
        name
    } else {
        match names.get(name).and_then(|target| target.first()) {
            Some(child) => child,
            None => return Ok(()),
        }
    };
    if *child != from[common] {
        siblings
            .entry(folder.to_vec())
            .or_default()
            .entry(from[common].clone())
            .or_default()
            .insert(child.clone());
    }
    Ok(())
}

/// The cycles met in a depth-first walk, each once, as `a, b, a`.
fn cycles(edges: &BTreeMap<String, BTreeSet<String>>) -> Vec<Vec<String>> {
    fn visit<'a>(
        node: &'a String,
        edges: &'a BTreeMap<String, BTreeSet<String>>,
        trail: &mut Vec<&'a String>,
        done: &mut BTreeSet<&'a String>,
        found: &mut Vec<Vec<String>>,
    ) {
        if let Some(start) = trail.iter().position(|n| *n == node) {
            let cycle = trail[start..].iter().copied().chain([node]);
            found.push(cycle.cloned().collect());
            return;
        }
        if !done.insert(node) {
            return;
        }
        trail.push(node);
        for next in edges.get(node).into_iter().flatten() {
            visit(next, edges, trail, done, found);
        }
        trail.pop();
    }
    let (mut done, mut found) = (BTreeSet::new(), Vec::new());
    for node in edges.keys() {
        visit(node, edges, &mut Vec::new(), &mut done, &mut found);
    }
    found
}

fn read_tree(root: &Path) -> Vec<File> {
    let mut paths = Vec::new();
    collect(root, &mut paths);
    paths
        .into_iter()
        .filter_map(|path| {
            let relative = path.strip_prefix(root).expect("found below the root");
            let mut module: Vec<String> = relative
                .with_extension("")
                .iter()
                .map(|part| part.to_string_lossy().into_owned())
                .collect();
            let is_folder = module.last().is_some_and(|last| last == "mod");
            if is_folder {
                module.pop();
            }
            let above = module.len() == 1 && ["lib", "main"].contains(&module[0].as_str());
            (!above).then(|| File {
                name: relative.display().to_string(),
                module,
                is_folder,
                text: fs::read_to_string(&path).expect("sources are readable"),
            })
        })
        .collect()
}

fn collect(folder: &Path, paths: &mut Vec<PathBuf>) {
    let mut entries: Vec<PathBuf> = fs::read_dir(folder)
        .expect("the tree is readable")
        .map(|entry| entry.expect("the tree is readable").path())
        .collect();
    entries.sort();
    for entry in entries {
        if entry.is_dir() {
            collect(&entry, paths);
        } else if entry.extension().is_some_and(|e| e == "rs") {
            paths.push(entry);
        }
    }
}
