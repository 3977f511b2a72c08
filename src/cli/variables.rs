//! Variables that stand for flags, and those that were probably meant to.

use super::flag_vocabulary::FlagVocabulary;
use crate::job::{Vocabulary, nearest};
use std::collections::BTreeSet;
use std::ffi::OsString;

/// Names another configuration file.
pub const FILE_VARIABLE: &str = "CERTILUX_CONFIG";
/// What the variables of flags begin with.
const PREFIX: &str = "CERTILUX_";

/// The variable of a flag: `CERTILUX_MIN_AREA` for `min-area`.
pub fn variable(key: &str) -> String {
    format!("{PREFIX}{}", key.replace('-', "_").to_uppercase())
}

/// What is to be said of variables that are those of no flag of any command but look like one, or of a flag in `typed_only`.
/// A file refuses unknown keys; a variable may be meant for another program.
pub fn doubtful_variables(
    names: impl Iterator<Item = OsString>,
    typed_only: &[&str],
) -> Vec<String> {
    let mut names: Vec<String> = names
        .filter_map(|name| name.into_string().ok())
        .filter(|name| name.starts_with(PREFIX) && name != FILE_VARIABLE)
        .collect();
    // Most often there is none, and nothing to look up.
    if names.is_empty() {
        return names;
    }
    names.sort();
    let keys: BTreeSet<String> = FlagVocabulary::commands()
        .iter()
        .filter_map(|command| FlagVocabulary::of(command, typed_only))
        .flat_map(|v| v.keys().into_iter().map(str::to_owned).collect::<Vec<_>>())
        .collect();
    names.retain(|name| !keys.iter().any(|key| variable(key) == *name));
    (names.into_iter())
        .filter_map(|name| {
            if let Some(key) = typed_only.iter().find(|key| variable(key) == name) {
                return Some(format!(
                    "{name} is not used: --{key} is given on the command line only"
                ));
            }
            // What all begin with makes none alike.
            let word = &name[PREFIX.len()..];
            let meant = nearest(word, keys.iter().map(String::as_str))?;
            Some(format!(
                "{name} is the variable of no flag; did you mean {}?",
                variable(meant)
            ))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn misspelt_variables_are_told_from_others() {
        let said = |name: &str| doubtful_variables([OsString::from(name)].into_iter(), &["resume"]);
        for name in [
            "CERTILUX_EPSILON",
            "CERTILUX_MIN_AREA",
            "CERTILUX_NO_VIEW",
            "CERTILUX_CONFIG",
            "CERTILUX_DEBIAN13",
            "EPSILOM",
            "HOME",
        ] {
            assert!(said(name).is_empty(), "{name}: {:?}", said(name));
        }
        for (name, words) in [
            ("CERTILUX_EPSILOM", "did you mean CERTILUX_EPSILON?"),
            ("CERTILUX_MINAREA", "did you mean CERTILUX_MIN_AREA?"),
            ("CERTILUX_RESUME", "--resume is given on the command line"),
        ] {
            let said = said(name);
            assert!(said.len() == 1 && said[0].contains(words), "{said:?}");
        }
    }
}
