//! A job list: defaults, and jobs with scenes, settings and grids. It is read and checked as a whole before
//! anything runs.

use super::grid::{MOST_COMBINATIONS, combinations};
use super::job_name::{check, is_builtin, scene_name, with_choices};
use super::nearest::suggestion;
use super::setting::{Setting, Vocabulary, override_settings, read_choices, read_setting};
use super::toml_source::{Entry, TomlError, TomlSource, kind};
use std::collections::HashMap;
use std::path::Path;
use toml::de::{DeTable, DeValue};

/// A solve to be made.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Job {
    /// Unique in its list; the name of its folder.
    pub name: String,
    /// Path of an OBJ file, or `builtin:NAME`.
    pub scene: String,
    /// Its settings, each once.
    pub settings: Vec<Setting>,
    /// Line of the list at which the job begins.
    pub line: usize,
}

const TOP_KEYS: [&str; 2] = ["defaults", "job"];
const JOB_KEYS: [&str; 3] = ["name", "scene", "grid"];

/// Reads the list at `path`. `base` are settings that hold where the list says nothing. Scenes are looked for from the
/// folder of the list.
///
/// # Errors
/// The first line that cannot be used, with the reason.
pub fn read_job_list(
    path: &Path,
    base: &[Setting],
    vocabulary: &dyn Vocabulary,
) -> Result<Vec<Job>, TomlError> {
    let source = TomlSource::read(path)?;
    let top = source.parse()?;
    let mut defaults = base.to_vec();
    let mut tables: Vec<(usize, &DeTable)> = Vec::new();
    for entry in source.entries(&top) {
        match (entry.key, entry.value.get_ref()) {
            ("defaults", DeValue::Table(table)) => {
                let own = read_settings(&source, table, vocabulary, &[])?;
                defaults = override_settings(&defaults, &own, vocabulary);
            }
            ("job", DeValue::Array(jobs)) => {
                for job in jobs.iter() {
                    let line = source.line(job.span());
                    match job.get_ref() {
                        DeValue::Table(table) => tables.push((line, table)),
                        other => {
                            let reason = format!("a job is a table, [[job]], not {}", kind(other));
                            return Err(source.error(line, reason));
                        }
                    }
                }
            }
            ("defaults" | "job", other) => {
                let brackets = if entry.key == "job" {
                    "[[job]]"
                } else {
                    "[defaults]"
                };
                let reason = format!(
                    "`{}` is written {brackets}, not as {}",
                    entry.key,
                    kind(other)
                );
                return Err(source.error(entry.line, reason));
            }
            (key, _) => {
                // A setting at the top was meant for all jobs.
                let reason = match vocabulary.is_switch(key) {
                    Some(_) => format!("`{key}` belongs under [defaults] or [[job]]"),
                    None => format!("unknown key `{key}`{}", suggestion(key, TOP_KEYS)),
                };
                return Err(source.error(entry.line, reason));
            }
        }
    }
    let mut jobs = Vec::new();
    for (line, table) in tables {
        read_job(&source, line, table, &defaults, vocabulary, &mut jobs)?;
    }
    if jobs.is_empty() {
        return Err(TomlError {
            path: path.to_path_buf(),
            line: None,
            reason: "lists no job; one begins with [[job]]".to_owned(),
        });
    }
    refuse_duplicates(&source, &jobs)?;
    Ok(jobs)
}

fn read_settings(
    source: &TomlSource,
    table: &DeTable<'_>,
    vocabulary: &dyn Vocabulary,
    also_known: &[&str],
) -> Result<Vec<Setting>, TomlError> {
    let entries = source.entries(table);
    let of_setting = |entry: &&Entry| !also_known.contains(&entry.key);
    let read = |entry: &Entry| read_setting(source, entry, vocabulary, also_known);
    entries.iter().filter(of_setting).map(read).collect()
}

fn read_job(
    source: &TomlSource,
    line: usize,
    table: &DeTable<'_>,
    defaults: &[Setting],
    vocabulary: &dyn Vocabulary,
    jobs: &mut Vec<Job>,
) -> Result<(), TomlError> {
    let own = read_settings(source, table, vocabulary, &JOB_KEYS)?;
    let settings = override_settings(defaults, &own, vocabulary);
    let (mut name, mut scenes, mut choices) = (None, None, Vec::new());
    for entry in source.entries(table) {
        match (entry.key, entry.value.get_ref()) {
            ("name", DeValue::String(text)) => name = Some((entry.line, text.as_ref())),
            ("scene", _) => scenes = Some(read_scenes(source, &entry)?),
            ("grid", DeValue::Table(grid)) => {
                choices = source
                    .entries(grid)
                    .iter()
                    .map(|entry| read_choices(source, entry, vocabulary))
                    .collect::<Result<_, _>>()?;
            }
            ("name", other) => {
                let reason = format!("`name` is a text, not {}", kind(other));
                return Err(source.error(entry.line, reason));
            }
            ("grid", other) => {
                let reason = format!("`grid` is written [job.grid], not as {}", kind(other));
                return Err(source.error(entry.line, reason));
            }
            _ => {}
        }
    }
    let Some(scenes) = scenes else {
        return Err(source.error(line, "the job has no `scene`"));
    };
    let Some(ways) = combinations(&choices) else {
        let reason = format!("the grid has more than {MOST_COMBINATIONS} combinations");
        return Err(source.error(line, reason));
    };
    for scene in &scenes.paths {
        let name = match name {
            Some((_, name)) if scenes.may_be_many => format!("{name}-{}", scene_name(scene)),
            Some((_, name)) => name.to_owned(),
            None => scene_name(scene),
        };
        for way in &ways {
            let name = with_choices(&name, way);
            check(&name).map_err(|reason| source.error(line, reason))?;
            let settings = override_settings(&settings, way, vocabulary);
            vocabulary
                .check(&settings)
                .map_err(|reason| source.error(line, format!("job {name:?}: {reason}")))?;
            jobs.push(Job {
                name,
                scene: scene.clone(),
                settings,
                line,
            });
        }
        if jobs.len() > MOST_COMBINATIONS {
            let reason = format!("there are more than {MOST_COMBINATIONS} jobs");
            return Err(source.error(line, reason));
        }
    }
    Ok(())
}

/// The scenes of a job.
struct Scenes {
    paths: Vec<String>,
    /// A list or a pattern: how many it names may change, so names of jobs always say which.
    may_be_many: bool,
}

fn read_scenes(source: &TomlSource, entry: &Entry<'_, '_>) -> Result<Scenes, TomlError> {
    let mut scenes = Scenes {
        paths: Vec::new(),
        may_be_many: false,
    };
    match entry.value.get_ref() {
        DeValue::String(text) => find_scenes(source, entry.line, text, &mut scenes)?,
        DeValue::Array(list) if !list.is_empty() => {
            scenes.may_be_many = true;
            for item in list.iter() {
                let line = source.line(item.span());
                let DeValue::String(text) = item.get_ref() else {
                    let reason = format!("a scene is a text, not {}", kind(item.get_ref()));
                    return Err(source.error(line, reason));
                };
                find_scenes(source, line, text, &mut scenes)?;
            }
        }
        other => {
            let reason = format!("`scene` is a text or a list of some, not {}", kind(other));
            return Err(source.error(entry.line, reason));
        }
    }
    Ok(scenes)
}

/// Adds what one text names: a built-in scene, a file, or what a pattern matches, in the order of names.
fn find_scenes(
    source: &TomlSource,
    line: usize,
    text: &str,
    scenes: &mut Scenes,
) -> Result<(), TomlError> {
    if text.is_empty() {
        return Err(source.error(line, "`scene` is empty"));
    }
    if is_builtin(text) {
        scenes.paths.push(text.to_owned());
        return Ok(());
    }
    let folder = source.path().parent().unwrap_or_else(|| Path::new(""));
    let path = folder.join(text);
    // A file may be called as a pattern would be.
    if path.exists() || !text.contains(['*', '?', '[']) {
        scenes.paths.push(path_text(source, line, &path)?);
        return Ok(());
    }
    scenes.may_be_many = true;
    let pattern = Path::new(&glob::Pattern::escape(&folder.to_string_lossy())).join(text);
    let matches = glob::glob(&pattern.to_string_lossy())
        .map_err(|e| source.error(line, format!("the pattern `{text}`: {}", e.msg)))?;
    let before = scenes.paths.len();
    for found in matches {
        let found = found.map_err(|e| source.error(line, format!("the pattern `{text}`: {e}")))?;
        scenes.paths.push(path_text(source, line, &found)?);
    }
    match scenes.paths.len() > before {
        true => Ok(()),
        false => Err(source.error(line, format!("no file matches `{text}`"))),
    }
}

fn path_text(source: &TomlSource, line: usize, path: &Path) -> Result<String, TomlError> {
    let text = path.to_str().map(str::to_owned);
    text.ok_or_else(|| source.error(line, format!("{}: the name is not UTF-8", path.display())))
}

fn refuse_duplicates(source: &TomlSource, jobs: &[Job]) -> Result<(), TomlError> {
    let mut seen: HashMap<&str, &Job> = HashMap::new();
    for job in jobs {
        if let Some(first) = seen.insert(&job.name, job) {
            let reason = format!(
                "two jobs are called {:?}: of line {} ({}) and of line {} ({}); `name` tells them apart",
                job.name, first.line, first.scene, job.line, job.scene
            );
            return Err(source.error(job.line, reason));
        }
    }
    Ok(())
}
