//! A configuration file: defaults of the command line, for every command at the top, for one command in a table
//! of its name.

use super::nearest::suggestion;
use super::setting::{Setting, Vocabulary, read_setting};
use super::toml_source::{TomlError, TomlSource};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use toml::de::DeValue;

/// What the file says.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SettingsFile {
    /// The file, for messages.
    pub path: PathBuf,
    /// For every command that has such a flag.
    pub general: Vec<Setting>,
    /// For one command, by its name.
    pub of_command: BTreeMap<String, Vec<Setting>>,
}

/// Reads a file. `commands` are the commands with their vocabularies; a general setting must be known to one of
/// them, and its value is checked by the first that knows it.
///
/// # Errors
/// The first line that cannot be used, with the reason.
pub fn read_settings_file(
    path: &Path,
    commands: &[(&str, &dyn Vocabulary)],
) -> Result<SettingsFile, TomlError> {
    let source = TomlSource::read(path)?;
    let mut file = SettingsFile {
        path: path.to_path_buf(),
        ..SettingsFile::default()
    };
    for entry in source.entries(&source.parse()?) {
        if let DeValue::Table(table) = entry.value.get_ref() {
            let Some((name, vocabulary)) = commands.iter().find(|(name, _)| *name == entry.key)
            else {
                let names = commands.iter().map(|(name, _)| *name);
                let reason = format!("no command `{}`{}", entry.key, suggestion(entry.key, names));
                return Err(source.error(entry.line, reason));
            };
            let settings = source
                .entries(table)
                .iter()
                .map(|entry| read_setting(&source, entry, *vocabulary, &[]))
                .collect::<Result<_, _>>()?;
            file.of_command.insert((*name).to_owned(), settings);
            continue;
        }
        let knows = |(_, v): &&(&str, &dyn Vocabulary)| v.is_switch(entry.key).is_some();
        let Some((_, vocabulary)) = commands.iter().find(knows) else {
            let mut names: Vec<&str> = commands.iter().flat_map(|(_, v)| v.keys()).collect();
            names.sort_unstable();
            let reason = format!(
                "unknown key `{}`{}",
                entry.key,
                suggestion(entry.key, names)
            );
            return Err(source.error(entry.line, reason));
        };
        file.general
            .push(read_setting(&source, &entry, *vocabulary, &[])?);
    }
    Ok(file)
}
