//! The layout is the data flow: a folder of `src/` imports only from folders before it in
//! [`ORDER`], and inside a folder the files import each other without a cycle.

mod paths;
mod rule;

use rule::violations;
use std::fs;
use std::path::Path;

/// The stages of the engine, first to last.
const ORDER: [&str; 12] = [
    "math",
    "embree",
    "scene",
    "cluster",
    "occluder",
    "visibility",
    "solve",
    "reference",
    "experiment",
    "output",
    "job",
    "cli",
];

#[test]
fn the_engine_follows_the_data_flow() {
    let report = violations(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"), &ORDER);
    assert!(report.files > 30, "only {} files were read", report.files);
    assert!(
        report.imports > 50,
        "only {} imports were found",
        report.imports
    );
    assert!(
        report.violations.is_empty(),
        "imports against the order {ORDER:?}:\n{}",
        report.violations.join("\n")
    );
}

/// Writes a made-up tree and judges it with the order `first`, `second`.
fn judge(files: &[(&str, &str)]) -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    violations(folder.path(), &["first", "second"]).violations
}

#[track_caller]
fn assert_one(found: &[String], words: &[&str]) {
    assert_eq!(found.len(), 1, "{found:?}");
    for word in words {
        assert!(found[0].contains(word), "{found:?} lacks {word}");
    }
}

#[test]
fn a_tree_in_order_passes() {
    let found = judge(&[
        ("lib.rs", "pub mod first; pub mod second;"),
        (
            "first/mod.rs",
            "mod base; mod top; mod own_tests; pub use base::{Base, Other as Renamed}; pub use top::Top;",
        ),
        (
            "first/base.rs",
            "pub struct Base; pub struct Other; // use crate::second::Late;
             /// See `crate::second::Late`.
             const TEXT: &str = \"crate::second::Late\";",
        ),
        (
            "first/top.rs",
            "use super::base::Base; use super::Renamed; pub struct Top;
             mod tests { use super::Top; use super::super::base::Other; }",
        ),
        (
            "first/own_tests.rs",
            "use super::{Base, Top}; use crate::first::top;",
        ),
        ("second/mod.rs", "mod late; pub use late::Late;"),
        (
            "second/late.rs",
            "use crate::first::{Base, top::Top}; pub struct Late; fn f() -> crate::first::Base { todo!() }",
        ),
    ]);
    assert!(found.is_empty(), "{found:?}");
}

#[test]
fn an_import_from_a_later_folder_is_found_wherever_it_stands() {
    for late in [
        "use crate::second::Late;",
        "use crate::{first::Base, second::{Late}};",
        "fn f() { let x: crate::second::Late; }",
        "fn f() { assert!(crate::second::late()); }",
        "mod tests { use crate::second::Late; }",
        "use super::super::second::Late;",
        "macro_rules! m { () => { $crate::second::Late } }",
    ] {
        let found = judge(&[
            ("lib.rs", ""),
            ("first/mod.rs", "mod base;"),
            ("first/base.rs", late),
            ("second/mod.rs", ""),
        ]);
        assert_one(&found, &["first/base.rs", "second"]);
    }
}

#[test]
fn a_folder_outside_the_order_is_found() {
    let found = judge(&[("lib.rs", ""), ("third/mod.rs", ""), ("first/mod.rs", "")]);
    assert_one(&found, &["third"]);
    let found = judge(&[
        ("lib.rs", ""),
        ("first/mod.rs", "mod base;"),
        ("first/base.rs", "use crate::helpers::help;"),
    ]);
    assert_one(&found, &["first/base.rs", "helpers"]);
}

#[test]
fn a_cycle_between_files_is_found() {
    let direct = judge(&[
        ("first/mod.rs", "mod a; mod b; mod c;"),
        ("first/a.rs", "use super::b::B;"),
        ("first/b.rs", "use crate::first::c::C;"),
        ("first/c.rs", "fn f() -> super::a::A { todo!() }"),
    ]);
    assert_one(&direct, &["a -> b -> c -> a"]);

    let through_re_exports = judge(&[
        (
            "first/mod.rs",
            "mod a; mod b; pub use a::{A, Other as Renamed}; pub(crate) use b::B;",
        ),
        ("first/a.rs", "use super::B; pub struct Other;"),
        ("first/b.rs", "use crate::first::Renamed;"),
    ]);
    assert_one(&through_re_exports, &["a -> b -> a"]);

    let in_a_sub_folder = judge(&[
        ("first/mod.rs", "mod deep; mod flat;"),
        ("first/flat.rs", "use super::deep::x::X;"),
        ("first/deep/mod.rs", "mod x; mod y;"),
        ("first/deep/x.rs", "use super::y::Y;"),
        ("first/deep/y.rs", "use super::super::deep::x::X;"),
    ]);
    assert_one(&in_a_sub_folder, &["first/deep", "x -> y -> x"]);

    let between_a_file_and_a_sub_folder = judge(&[
        ("first/mod.rs", "mod deep; mod flat;"),
        ("first/flat.rs", "use super::deep::X;"),
        ("first/deep/mod.rs", "mod x; pub use x::X;"),
        ("first/deep/x.rs", "use super::super::flat::F;"),
    ]);
    assert_one(&between_a_file_and_a_sub_folder, &["deep -> flat -> deep"]);
}

#[test]
fn a_glob_of_the_own_folder_is_found_because_it_hides_cycles() {
    let found = judge(&[
        ("first/mod.rs", "mod a; mod b; pub use b::B;"),
        ("first/a.rs", "use super::*;"),
        ("first/b.rs", "pub struct B; mod tests { use super::*; }"),
    ]);
    assert_one(&found, &["first/a.rs", "*"]);
}
