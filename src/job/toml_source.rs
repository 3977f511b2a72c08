//! A TOML file with the line of everything in it.

use std::borrow::Cow;
use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Something in a TOML file that cannot be used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TomlError {
    /// The file.
    pub path: PathBuf,
    /// The line, from 1; none where the file as a whole is meant.
    pub line: Option<usize>,
    /// What is wrong.
    pub reason: String,
}

impl fmt::Display for TomlError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.line {
            Some(line) => write!(f, "{}:{line}: {}", self.path.display(), self.reason),
            None => write!(f, "{}: {}", self.path.display(), self.reason),
        }
    }
}

impl std::error::Error for TomlError {}

/// Most bytes of a file that is written by hand: more is a mistake, such as a scene in its place.
const MOST_BYTES: u64 = 16 << 20;

/// The text of a file, for messages that name its lines.
pub struct TomlSource {
    path: PathBuf,
    text: String,
}

/// A key, its value, and where the key stands.
pub struct Entry<'a, 'i> {
    /// The key.
    pub key: &'a str,
    /// What it is set to.
    pub value: &'a Spanned<DeValue<'i>>,
    /// Line of the key.
    pub line: usize,
}

impl TomlSource {
    /// Reads a file.
    ///
    /// # Errors
    /// Where it cannot be read, is no regular file or no text.
    pub fn read(path: &Path) -> Result<Self, TomlError> {
        let refuse = |reason: String| TomlError {
            path: path.to_path_buf(),
            line: None,
            reason,
        };
        let found = std::fs::metadata(path).map_err(|e| refuse(format!("cannot be read: {e}")))?;
        if !found.is_file() {
            return Err(refuse("is not a regular file".to_owned()));
        }
        if found.len() > MOST_BYTES {
            return Err(refuse(format!(
                "has {} bytes; that is no list written by hand",
                found.len()
            )));
        }
        let bytes = std::fs::read(path).map_err(|e| refuse(format!("cannot be read: {e}")))?;
        let text = String::from_utf8(bytes).map_err(|e| {
            let valid = &e.as_bytes()[..e.utf8_error().valid_up_to()];
            TomlError {
                line: Some(1 + valid.iter().filter(|&&b| b == b'\n').count()),
                ..refuse("is not UTF-8".to_owned())
            }
        })?;
        Ok(Self {
            path: path.to_path_buf(),
            text,
        })
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The top table.
    ///
    /// # Errors
    /// The first place that is not TOML.
    pub fn parse(&self) -> Result<DeTable<'_>, TomlError> {
        DeTable::parse(&self.text)
            .map(Spanned::into_inner)
            .map_err(|error| TomlError {
                path: self.path.clone(),
                line: error.span().map(|span| self.line(span)),
                reason: error.message().trim().replace('\n', "; "),
            })
    }

    /// An error at a line.
    pub fn error(&self, line: usize, reason: impl Into<String>) -> TomlError {
        TomlError {
            path: self.path.clone(),
            line: Some(line),
            reason: reason.into(),
        }
    }

    /// The line in which a span begins.
    pub fn line(&self, span: Range<usize>) -> usize {
        let before = &self.text.as_bytes()[..span.start.min(self.text.len())];
        1 + before.iter().filter(|&&b| b == b'\n').count()
    }

    /// The entries of a table in the order of the file.
    pub fn entries<'a, 'i>(&self, table: &'a DeTable<'i>) -> Vec<Entry<'a, 'i>> {
        let mut entries: Vec<(usize, Entry)> = table
            .iter()
            .map(|(key, value)| {
                let entry = Entry {
                    key: key.get_ref().as_ref(),
                    value,
                    line: self.line(key.span()),
                };
                (key.span().start, entry)
            })
            .collect();
        entries.sort_by_key(|&(start, _)| start);
        entries.into_iter().map(|(_, entry)| entry).collect()
    }
}

/// A single value as the command line would have it; `None` for tables, arrays and dates.
pub fn as_text<'a>(value: &'a DeValue<'_>) -> Option<Cow<'a, str>> {
    match value {
        DeValue::String(text) => Some(Cow::Borrowed(text.as_ref())),
        DeValue::Integer(number) if number.radix() == 10 => Some(Cow::Borrowed(number.as_str())),
        DeValue::Integer(number) => i128::from_str_radix(number.as_str(), number.radix())
            .ok()
            .map(|n| Cow::Owned(n.to_string())),
        DeValue::Float(number) => Some(Cow::Borrowed(number.as_str())),
        _ => None,
    }
}

/// What a value is called in messages.
pub fn kind(value: &DeValue<'_>) -> &'static str {
    match value {
        DeValue::String(_) => "a text",
        DeValue::Integer(_) | DeValue::Float(_) => "a number",
        DeValue::Boolean(_) => "true or false",
        DeValue::Datetime(_) => "a date",
        DeValue::Array(_) => "a list",
        DeValue::Table(_) => "a table",
    }
}
