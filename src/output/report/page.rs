//! The page: what the folders hold, one section each, with its style and the few lines of script that sort tables.

use super::super::error::OutputError;
use super::super::stats_file::write_text;
use super::comparison_section::{Comparison, comparison_section};
use super::solve_section::{Stats, solve_section};
use super::sweep_section::{Plot, sweep_section};
use serde::de::DeserializeOwned;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use thiserror::Error;

/// Why there is no report.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ReportError {
    /// A folder cannot be read.
    #[error("{}: cannot be read: {reason}", path.display())]
    Unreadable {
        /// The folder or file.
        path: PathBuf,
        /// The system's words.
        reason: std::io::Error,
    },
    /// A folder holds nothing to report.
    #[error(
        "{}: holds no stats.json of a solve, no JSON of a comparison and no sweep.csv",
        path.display()
    )]
    Nothing {
        /// The folder.
        path: PathBuf,
    },
    /// A file is not what its name says.
    #[error("{}: line {line}: {reason}", path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// What is wrong.
        reason: String,
    },
    /// The page cannot be written.
    #[error(transparent)]
    Output(#[from] OutputError),
}

/// Writes one page over `folders`, in their order: solves, comparisons (`certilux compare --json`) and sweeps. Nothing is
/// written if one of them cannot be read.
pub fn write_report(
    out: &Path,
    folders: &[PathBuf],
    interrupted: &AtomicBool,
) -> Result<(), ReportError> {
    let mut sections = String::new();
    for folder in folders {
        sections.push_str(&folder_sections(folder)?);
    }
    let page = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>certilux report</title>\n\
         <link rel=\"icon\" href=\"data:,\">\n<style>{STYLE}</style>\n</head>\n<body>\n<h1>certilux report</h1>\n{sections}\
         <script>{SCRIPT}</script>\n</body>\n</html>\n"
    );
    write_text(out, &page, interrupted)?;
    Ok(())
}

fn folder_sections(folder: &Path) -> Result<String, ReportError> {
    let unreadable = |reason| ReportError::Unreadable {
        path: folder.to_owned(),
        reason,
    };
    let mut names: Vec<PathBuf> = fs::read_dir(folder)
        .map_err(unreadable)?
        .map(|entry| entry.map(|e| e.path()))
        .collect::<Result<_, _>>()
        .map_err(unreadable)?;
    names.sort();
    let title = folder.display().to_string();
    let mut out = String::new();
    let stats = folder.join("stats.json");
    if stats.is_file() {
        let stats: Stats = read_json(&stats)?;
        let picture = fs::read(folder.join("view.png")).ok();
        out.push_str(&solve_section(&title, &stats, picture.as_deref()));
    }
    for path in names.iter().filter(|p| has_ending(p, "json")) {
        if let Some(comparison) = read_comparison(path)? {
            let title = path.display().to_string();
            out.push_str(&comparison_section(&title, &comparison));
        }
    }
    let csv = folder.join("sweep.csv");
    if csv.is_file() {
        let csv = read(&csv)?;
        let plots = (names.iter())
            .filter(|p| has_ending(p, "svg"))
            .map(|path| {
                Ok(Plot {
                    name: path
                        .file_name()
                        .map(|n| n.to_string_lossy().into_owned())
                        .unwrap_or_default(),
                    svg: read(path)?,
                })
            })
            .collect::<Result<Vec<Plot>, ReportError>>()?;
        out.push_str(&sweep_section(
            &title,
            &String::from_utf8_lossy(&csv),
            &plots,
        ));
    }
    if out.is_empty() {
        return Err(ReportError::Nothing {
            path: folder.to_owned(),
        });
    }
    Ok(out)
}

fn has_ending(path: &Path, ending: &str) -> bool {
    path.extension().is_some_and(|e| e == ending) && path.is_file()
}

fn read(path: &Path) -> Result<Vec<u8>, ReportError> {
    fs::read(path).map_err(|reason| ReportError::Unreadable {
        path: path.to_owned(),
        reason,
    })
}

fn read_json<T: DeserializeOwned>(path: &Path) -> Result<T, ReportError> {
    serde_json::from_slice(&read(path)?).map_err(|e| ReportError::Malformed {
        path: path.to_owned(),
        line: e.line(),
        reason: e.to_string(),
    })
}

/// A comparison, or `None` if the file is some other JSON.
fn read_comparison(path: &Path) -> Result<Option<Comparison>, ReportError> {
    let value: serde_json::Value = read_json(path)?;
    let is_comparison = value["rows"].is_array() && value["summary"].is_array();
    match is_comparison {
        true => read_json(path).map(Some),
        false => Ok(None),
    }
}

/// Readable on a phone and in print; follows the reader's choice of light or dark.
const STYLE: &str = "
:root{color-scheme:light dark;--ink:#1a1a1a;--paper:#fff;--line:#ccc;--faint:#f4f4f4}
@media(prefers-color-scheme:dark){:root{--ink:#e8e8e8;--paper:#161616;--line:#444;--faint:#222}}
body{font:16px/1.5 system-ui,sans-serif;color:var(--ink);background:var(--paper);max-width:70rem;margin:0 auto;padding:1rem}
h2{overflow-wrap:anywhere;border-bottom:1px solid var(--line);margin-top:2.5rem}
img.view,img.plot{max-width:100%;height:auto;display:block;margin:1rem 0}
img.plot{background:#fff}
.wide{overflow-x:auto}
table{border-collapse:collapse;margin:1rem 0;font-variant-numeric:tabular-nums}
caption{text-align:left;font-weight:600;padding:.3rem 0}
th,td{border-bottom:1px solid var(--line);padding:.25rem .6rem;text-align:left;white-space:nowrap}
th{white-space:normal;vertical-align:bottom}
th.n,td.n{text-align:right}
th button{all:unset;cursor:pointer;font-weight:600}
th button:focus-visible{outline:2px solid}
th[aria-sort=ascending] button::after{content:' \\2191'}
th[aria-sort=descending] button::after{content:' \\2193'}
figure.chart{margin:1rem 0}
figure.chart svg{width:100%;height:1.75rem;display:block}
figcaption{font-weight:600}
ul.legend{list-style:none;display:flex;flex-wrap:wrap;gap:.2rem 1.2rem;padding:0;margin:.4rem 0}
ul.legend span{display:inline-block;width:.8rem;height:.8rem;margin-right:.4rem;-webkit-print-color-adjust:exact;print-color-adjust:exact}
ul.warnings li{overflow-wrap:anywhere}
pre{white-space:pre-wrap;overflow-wrap:anywhere;background:var(--faint);padding:.6rem}
@media print{body{max-width:none}section{break-before:page}section:first-of-type{break-before:auto}.wide{overflow:visible}table{font-size:6pt;width:100%}th,td{padding:.1rem .12rem}th{font-size:5.5pt}img,figure,tr{break-inside:avoid}h2,h3,caption,figcaption{break-after:avoid}}
";

/// Sorts a table by the column whose head is pressed; a second press turns the order about.
const SCRIPT: &str = "
document.querySelectorAll('table.sortable').forEach(function(table){
  table.querySelectorAll('th').forEach(function(head,column){
    head.querySelector('button').addEventListener('click',function(){
      var up=head.getAttribute('aria-sort')!=='ascending';
      table.querySelectorAll('th').forEach(function(h){h.removeAttribute('aria-sort')});
      head.setAttribute('aria-sort',up?'ascending':'descending');
      var body=table.tBodies[0],rows=Array.prototype.slice.call(body.rows);
      rows.sort(function(a,b){
        var x=a.cells[column],y=b.cells[column],m=x.dataset.n,n=y.dataset.n,order;
        order=m!==undefined&&n!==undefined?m-n:x.textContent.localeCompare(y.textContent);
        return up?order:-order;
      });
      rows.forEach(function(row){body.appendChild(row)});
    });
  });
});
addEventListener('beforeprint',function(){
  document.querySelectorAll('details').forEach(function(d){d.open=true});
});
";

#[cfg(test)]
mod tests {
    use super::*;

    const STATS: &str = r#"{ "certilux": "0.1.0", "embree": "4.3.3", "command": ["certilux", "solve", "<b>.obj"],
        "seed": 1, "threads": 2, "technique": "occlusion", "epsilon": 1e-5, "rays_per_exchange": 8,
        "scene": { "path": "<b>.obj", "faces": 2, "polygons": 2, "area": 1.5, "dropped_faces": [3], "warnings": ["Ks & co"] },
        "hierarchy": { "face_clusters": 1, "volume_clusters": 0, "occluders": 0, "leaves": 9, "bytes": 100 },
        "passes": [ { "pass": 1, "seconds": 0.5, "exchanges": 10, "exchanges_blocked": 2, "exchanges_sampled_clear": 3,
            "rays": 80, "native_rays": 0, "shafts": 4, "occluded_claims": 1, "visible_claims": 1, "exchanges_visible": 4, "unshot": 0.25 } ],
        "seconds": { "load": 0.1, "cluster": 0.1, "occluders": 0.1, "embree": 0.1, "solve": 0.5, "output": 0.1 },
        "power": { "emitted": 2.0, "absorbed": 1.5, "escaped": 0.25, "escaped_stderr": 0.01, "unshot": 0.2, "imbalance": 0.025 } }"#;

    fn report(folder: &Path) -> Result<String, ReportError> {
        let out = folder.join("report.html");
        write_report(&out, &[folder.to_owned()], &AtomicBool::new(false))?;
        Ok(fs::read_to_string(out).unwrap())
    }

    #[test]
    fn a_page_asks_nothing_of_the_network_and_runs_nothing_of_the_data() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("stats.json"), STATS).unwrap();
        fs::write(
            folder.path().join("sweep.csv"),
            "technique,error\nnormal,0.5\n",
        )
        .unwrap();
        fs::write(folder.path().join("plot.svg"), "<svg/>").unwrap();
        let page = report(folder.path()).unwrap();
        assert!(!page.contains("http") && !page.contains("<b>.obj"));
        assert!(page.contains("&lt;b&gt;.obj") && page.contains("Ks &amp; co"));
        assert!(page.contains("+2.50 %") && page.contains("1 faces were dropped"));
        // Four of ten exchanges needed no ray.
        assert!(page.contains("proved visible, no ray <b>4 exchanges</b> (40.0 %)"));
        // Eight rays each of 4 exchanges, of 1 claim at least, and 80 that were cast.
        assert!(page.contains("saved by full visibility <b>32 rays</b> (26.7 %)"));
        assert!(page.contains("at the very least <b>8 rays</b> (6.7 %)"));
        assert!(page.contains("data:image/svg+xml;base64,PHN2Zy8+"));
        assert_eq!(page.matches("<section>").count(), 2);
        assert_eq!(
            page.matches("<section>").count(),
            page.matches("</section>").count()
        );
    }

    #[test]
    fn a_folder_without_results_and_a_broken_file_are_named_and_nothing_is_written() {
        let folder = tempfile::tempdir().unwrap();
        assert!(matches!(
            report(folder.path()),
            Err(ReportError::Nothing { .. })
        ));
        fs::write(folder.path().join("stats.json"), "{\n\"seed\": oops").unwrap();
        let error = report(folder.path()).unwrap_err();
        assert!(
            matches!(error, ReportError::Malformed { line: 2, .. }),
            "{error}"
        );
        assert!(!folder.path().join("report.html").exists());
        let missing = folder.path().join("nowhere");
        assert!(matches!(
            report(&missing),
            Err(ReportError::Unreadable { .. })
        ));
    }
}
