//! `report`: one page over what other commands wrote.

use crate::command::Folder;
use std::fs;

#[test]
fn a_solve_is_reported_on_one_page() {
    let folder = Folder::new();
    folder
        .line("solve builtin:cornell --epsilon 1e-3 --passes 2 --out solved")
        .ends_with(0, "solve");
    folder
        .line("report solved --out report.html")
        .ends_with(0, "report");
    let page = fs::read_to_string(folder.path("report.html")).unwrap();
    assert!(page.starts_with("<!DOCTYPE html>") && page.trim_end().ends_with("</html>"));
    assert!(page.contains("data:image/png;base64,iVBORw0KGgo"));
    for heading in [
        "Where the energy went",
        "Where the time went",
        "What the exchanges needed",
        "To reproduce it",
    ] {
        assert!(page.contains(heading), "{heading}");
    }
    // Nothing is fetched: no address, and no source but data.
    assert!(!page.contains("://"));
    assert_eq!(
        page.matches("src=").count(),
        page.matches("src=\"data:").count()
    );
}

#[test]
fn a_folder_with_nothing_to_report_is_named() {
    let folder = Folder::new();
    fs::create_dir(folder.path("empty")).unwrap();
    let run = folder.line("report empty --out report.html");
    run.ends_with(2, "report of an empty folder");
    assert!(!folder.path("report.html").exists());
}
