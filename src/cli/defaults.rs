//! Flags that the command line does not give: from the environment, else from the configuration file.
//!
//! Precedence: flag, `CERTILUX_<FLAG>`, the command's table in `certilux.toml`, the top of `certilux.toml`,
//! built-in. What is given at one level also overrules, below it, what excludes it.

use super::args::Cli;
use super::error::CliError;
use super::flag_vocabulary::{FlagVocabulary, first_sentence};
use super::variables::{FILE_VARIABLE, doubtful_variables, variable};
use crate::job::{
    Setting, SettingValue, SettingsFile, Vocabulary, override_settings, read_settings_file,
};
use clap::parser::ValueSource;
use clap::{ArgMatches, CommandFactory, FromArgMatches, Parser};
use std::collections::BTreeMap;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// The configuration file, in the current folder.
const FILE_NAME: &str = "certilux.toml";
/// Flags that no file or variable may give: the first would contradict itself, the others are decisions about one run.
pub const NEVER_DEFAULT: [&str; 5] = ["no-config", "list", "resume", "only", "list-names"];

/// The command line with all levels of defaults in it.
pub struct Filled {
    /// As parsed.
    pub cli: Cli,
    /// Where each flag came from that was not on the command line.
    pub sources: BTreeMap<String, String>,
    /// What looks like a mistake.
    pub warnings: Vec<String>,
}

/// Parses `arguments`, the program's name first, and fills in the defaults.
///
/// # Errors
/// What is wrong with the arguments, a variable or the file, naming it.
pub fn parse(arguments: &[OsString]) -> Result<Filled, CliError> {
    let matches = Cli::command().try_get_matches_from(arguments)?;
    let given = Filled {
        cli: Cli::from_arg_matches(&matches)?,
        sources: BTreeMap::new(),
        warnings: Vec::new(),
    };
    let Some((name, sub)) = matches.subcommand().filter(|_| !given.cli.no_config) else {
        return Ok(given);
    };
    let Some(vocabulary) = FlagVocabulary::of(name, &NEVER_DEFAULT) else {
        return Ok(given);
    };
    let given = Filled {
        warnings: doubtful_variables(std::env::vars_os().map(|(name, _)| name), &NEVER_DEFAULT),
        ..given
    };
    let levels = Levels::read(name, &vocabulary)?;
    let typed = typed_flags(&vocabulary, sub);
    let wanted: Vec<(Setting, String)> = levels.below(&typed, &vocabulary);
    if wanted.is_empty() {
        return Ok(given);
    }
    let words = |settings: &[(Setting, String)]| -> Vec<OsString> {
        let extra = settings.iter().filter_map(|(s, _)| s.argument());
        // Right behind the name of the command: what follows may end the flags by `--`.
        let at = 1 + (arguments.iter().position(|a| a == name)).unwrap_or(arguments.len() - 1);
        let (head, tail) = arguments.split_at(at);
        (head.iter().cloned())
            .chain(extra.map(OsString::from))
            .chain(tail.iter().cloned())
            .collect()
    };
    let cli = Cli::try_parse_from(words(&wanted)).map_err(|error| {
        let alone = |one: &&(Setting, String)| {
            Cli::try_parse_from(words(std::slice::from_ref(one))).is_err()
        };
        let reason = first_sentence(&error);
        CliError::Argument(match wanted.iter().find(alone) {
            Some((_, source)) => format!("{source}: {reason}"),
            None => reason,
        })
    })?;
    let sources = wanted.into_iter().map(|(s, source)| (s.key, source));
    Ok(Filled {
        cli,
        sources: sources.collect(),
        warnings: given.warnings,
    })
}

/// What a solve is told by the environment and the file where nobody tells it anything else: the base of a batch.
///
/// # Errors
/// As [`parse`].
pub fn defaults_of(name: &str, vocabulary: &FlagVocabulary) -> Result<Vec<Setting>, CliError> {
    let levels = Levels::read(name, vocabulary)?;
    let settings = levels.below(&[], vocabulary);
    Ok(settings.into_iter().map(|(setting, _)| setting).collect())
}

/// The flags that were typed, as settings without values.
fn typed_flags(vocabulary: &FlagVocabulary, matches: &ArgMatches) -> Vec<Setting> {
    let is_typed = |key: &&str| {
        vocabulary
            .id(key)
            .is_some_and(|id| matches.value_source(id) == Some(ValueSource::CommandLine))
    };
    let keys = vocabulary.keys();
    keys.into_iter()
        .filter(is_typed)
        .map(|key| Setting {
            key: key.to_owned(),
            value: SettingValue::On,
            line: 0,
        })
        .collect()
}

/// The levels of defaults.
struct Levels {
    environment: Vec<Setting>,
    file: SettingsFile,
    command: String,
}

impl Levels {
    fn read(command: &str, vocabulary: &FlagVocabulary) -> Result<Self, CliError> {
        Ok(Self {
            environment: environment(vocabulary)?,
            file: file()?,
            command: command.to_owned(),
        })
    }

    /// What holds below the flags in `typed`, with the place that it comes from.
    fn below(&self, typed: &[Setting], vocabulary: &FlagVocabulary) -> Vec<(Setting, String)> {
        let known = |s: &&Setting| vocabulary.is_switch(&s.key).is_some();
        let general: Vec<Setting> = self.file.general.iter().filter(known).cloned().collect();
        let own = self.file.of_command.get(&self.command);
        let own: &[Setting] = own.map_or(&[], Vec::as_slice);
        let in_file = override_settings(&general, own, vocabulary);
        let mut levels = override_settings(&in_file, &self.environment, vocabulary);
        levels.retain(|s| !typed.iter().any(|t| vocabulary.excludes(&s.key, &t.key)));
        let place = |setting: &Setting| match setting.line {
            0 => variable(&setting.key),
            line => format!("{}:{line}", self.file.path.display()),
        };
        let with_place = |setting: Setting| {
            let place = place(&setting);
            (setting, place)
        };
        levels.into_iter().map(with_place).collect()
    }
}

fn environment(vocabulary: &FlagVocabulary) -> Result<Vec<Setting>, CliError> {
    let mut settings = Vec::new();
    for key in vocabulary.keys() {
        let name = variable(key);
        let Some(text) = std::env::var_os(&name).filter(|text| !text.is_empty()) else {
            continue;
        };
        let refuse = |reason: String| CliError::Argument(format!("{name}: {reason}"));
        let text = text
            .into_string()
            .map_err(|_| refuse("is not UTF-8".to_owned()))?;
        let value = match (vocabulary.is_switch(key), text.as_str()) {
            (Some(true), "1" | "true") => SettingValue::On,
            (Some(true), "0" | "false") => SettingValue::Off,
            (Some(true), _) => return Err(refuse("1 or 0 is needed".to_owned())),
            _ => SettingValue::Text(text),
        };
        let setting = Setting {
            key: key.to_owned(),
            value,
            line: 0,
        };
        vocabulary
            .check(std::slice::from_ref(&setting))
            .map_err(refuse)?;
        settings.push(setting);
    }
    Ok(settings)
}

fn file() -> Result<SettingsFile, CliError> {
    let path = match std::env::var_os(FILE_VARIABLE).filter(|text| !text.is_empty()) {
        Some(named) => PathBuf::from(named),
        None if Path::new(FILE_NAME).exists() => PathBuf::from(FILE_NAME),
        None => return Ok(SettingsFile::default()),
    };
    let names = FlagVocabulary::commands();
    let vocabularies: Vec<(&str, FlagVocabulary)> = names
        .iter()
        .filter_map(|name| Some((name.as_str(), FlagVocabulary::of(name, &NEVER_DEFAULT)?)))
        .collect();
    let commands: Vec<(&str, &dyn Vocabulary)> = vocabularies
        .iter()
        .map(|(name, vocabulary)| (*name, vocabulary as &dyn Vocabulary))
        .collect();
    Ok(read_settings_file(&path, &commands)?)
}
