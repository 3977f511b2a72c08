//! One setting of a solve in a file: a flag of the command line without its dashes.

use super::nearest::suggestion;
use super::toml_source::{Entry, TomlError, TomlSource, as_text, kind};
use toml::de::DeValue;

/// What a setting is set to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SettingValue {
    /// A flag that is raised.
    On,
    /// A flag that is not, whatever is said elsewhere.
    Off,
    /// A value.
    Text(String),
}

/// A setting and where it stands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Setting {
    /// Name of the flag, without dashes.
    pub key: String,
    /// What it is set to.
    pub value: SettingValue,
    /// Line of its file, from 1.
    pub line: usize,
}

impl Setting {
    /// As a word of the command line; `None` for a flag that is off.
    pub fn argument(&self) -> Option<String> {
        match &self.value {
            SettingValue::On => Some(format!("--{}", self.key)),
            SettingValue::Off => None,
            SettingValue::Text(text) => Some(format!("--{}={text}", self.key)),
        }
    }
}

/// What the command line knows about settings.
pub trait Vocabulary {
    /// Names of all settings.
    fn keys(&self) -> Vec<&str>;
    /// Whether a setting is a flag that takes no value; `None` where there is no such setting.
    fn is_switch(&self, key: &str) -> Option<bool>;
    /// Whether a setting takes several values, parted by commas.
    fn is_list(&self, key: &str) -> bool;
    /// Whether two settings exclude each other, or are one.
    fn excludes(&self, one: &str, other: &str) -> bool;
    /// Whether these settings together are acceptable.
    ///
    /// # Errors
    /// Why they are not, in the words of the command line.
    fn check(&self, settings: &[Setting]) -> Result<(), String>;
}

/// `lower` with what `upper` says in its place.
pub fn override_settings(
    lower: &[Setting],
    upper: &[Setting],
    vocabulary: &dyn Vocabulary,
) -> Vec<Setting> {
    let stays = |setting: &&Setting| {
        let excluded = |other: &Setting| vocabulary.excludes(&setting.key, &other.key);
        !upper.iter().any(excluded)
    };
    lower.iter().filter(stays).chain(upper).cloned().collect()
}

/// Reads one entry as a setting and checks it by itself.
pub fn read_setting(
    source: &TomlSource,
    entry: &Entry<'_, '_>,
    vocabulary: &dyn Vocabulary,
    also_known: &[&str],
) -> Result<Setting, TomlError> {
    let key = check_key(source, entry, vocabulary, also_known)?;
    let value = read_value(vocabulary, key, entry.value.get_ref())
        .map_err(|reason| source.error(entry.line, format!("`{key}`: {reason}")))?;
    checked(source, vocabulary, key, value, entry.line)
}

/// Reads the values of one entry of a grid.
pub fn read_choices(
    source: &TomlSource,
    entry: &Entry<'_, '_>,
    vocabulary: &dyn Vocabulary,
) -> Result<Vec<Setting>, TomlError> {
    let key = check_key(source, entry, vocabulary, &[])?;
    let DeValue::Array(values) = entry.value.get_ref() else {
        let found = kind(entry.value.get_ref());
        let reason = format!("`{key}`: a grid needs a list of values, not {found}");
        return Err(source.error(entry.line, reason));
    };
    if values.is_empty() {
        return Err(source.error(entry.line, format!("`{key}`: the list is empty")));
    }
    values
        .iter()
        .map(|value| {
            let line = source.line(value.span());
            let value = read_value(vocabulary, key, value.get_ref())
                .map_err(|reason| source.error(line, format!("`{key}`: {reason}")))?;
            checked(source, vocabulary, key, value, line)
        })
        .collect()
}

fn check_key<'a>(
    source: &TomlSource,
    entry: &Entry<'a, '_>,
    vocabulary: &dyn Vocabulary,
    also_known: &[&str],
) -> Result<&'a str, TomlError> {
    let key = entry.key;
    if vocabulary.is_switch(key).is_some() {
        return Ok(key);
    }
    let known = vocabulary.keys();
    let known = known.iter().chain(also_known).copied();
    let reason = format!("unknown key `{key}`{}", suggestion(key, known));
    Err(source.error(entry.line, reason))
}

fn read_value(
    vocabulary: &dyn Vocabulary,
    key: &str,
    value: &DeValue<'_>,
) -> Result<SettingValue, String> {
    let is_switch = vocabulary.is_switch(key).unwrap_or(false);
    match value {
        DeValue::Boolean(true) if is_switch => Ok(SettingValue::On),
        DeValue::Boolean(false) if is_switch => Ok(SettingValue::Off),
        other if is_switch => Err(format!("true or false is needed, not {}", kind(other))),
        DeValue::Array(values) if vocabulary.is_list(key) => values
            .iter()
            .map(|v| as_text(v.get_ref()).ok_or_else(|| wrong_kind(v.get_ref())))
            .collect::<Result<Vec<_>, _>>()
            .map(|texts| SettingValue::Text(texts.join(","))),
        other => as_text(other)
            .map(|text| SettingValue::Text(text.into_owned()))
            .ok_or_else(|| wrong_kind(other)),
    }
}

fn wrong_kind(value: &DeValue<'_>) -> String {
    format!("a single value is needed, not {}", kind(value))
}

fn checked(
    source: &TomlSource,
    vocabulary: &dyn Vocabulary,
    key: &str,
    value: SettingValue,
    line: usize,
) -> Result<Setting, TomlError> {
    let setting = Setting {
        key: key.to_owned(),
        value,
        line,
    };
    match vocabulary.check(std::slice::from_ref(&setting)) {
        Ok(()) => Ok(setting),
        Err(reason) => Err(source.error(line, format!("`{key}`: {reason}"))),
    }
}
