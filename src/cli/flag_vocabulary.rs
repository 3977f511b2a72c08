//! The flags of a command as keys of a file: what they are called, what they take, what they exclude. It is read
//! off the command line's own description, so that no flag can be forgotten.

use super::args::Cli;
use super::solve_args::SolveArgs;
use crate::job::{Setting, Vocabulary};
use clap::error::ErrorKind;
use clap::{Arg, ArgAction, Command, CommandFactory, FromArgMatches};

/// A flag that only commands with all of [`SolveArgs`] have; those of a sweep are lists.
const MARK_OF_SOLVING: &str = "quality";

/// The optional flags of one command.
pub struct FlagVocabulary {
    /// The command with nothing required of it, to try settings on.
    command: Command,
    flags: Vec<Flag>,
}

struct Flag {
    key: String,
    id: String,
    is_switch: bool,
    is_list: bool,
    excludes: Vec<String>,
}

impl FlagVocabulary {
    /// Of the command called `name`, without the flags in `reserved` and without those that name files: a file that
    /// lies about in a folder must not choose what is overwritten.
    pub fn of(name: &str, reserved: &[&str]) -> Option<Self> {
        let mut cli = Cli::command();
        cli.build();
        let command = cli.find_subcommand(name)?;
        let long = |arg: &Arg| arg.get_long().map(str::to_owned);
        let flags = command
            .get_arguments()
            .filter(|arg| is_offered(arg))
            .filter_map(|arg| {
                let key = long(arg).filter(|key| !reserved.contains(&key.as_str()))?;
                Some(Flag {
                    key,
                    id: arg.get_id().to_string(),
                    is_switch: matches!(arg.get_action(), ArgAction::SetTrue),
                    is_list: arg.get_value_delimiter().is_some(),
                    excludes: command
                        .get_arg_conflicts_with(arg)
                        .into_iter()
                        .filter_map(long)
                        .collect(),
                })
            })
            .collect();
        Some(Self {
            command: command.clone().no_binary_name(true).mut_args(|arg| {
                match arg.is_required_set() {
                    true => arg.required(false),
                    false => arg,
                }
            }),
            flags,
        })
    }

    /// The commands, by their names.
    pub fn commands() -> Vec<String> {
        let cli = Cli::command();
        let names = cli.get_subcommands().map(|c| c.get_name().to_owned());
        names.collect()
    }

    /// What the parser calls a flag.
    pub fn id(&self, key: &str) -> Option<&str> {
        self.flag(key).map(|flag| flag.id.as_str())
    }

    fn flag(&self, key: &str) -> Option<&Flag> {
        self.flags.iter().find(|flag| flag.key == key)
    }
}

fn is_offered(arg: &Arg) -> bool {
    let names_a_file = arg.get_value_names().is_some_and(|names| {
        names
            .iter()
            .any(|n| n.starts_with("FILE") || n.starts_with("DIR"))
    });
    let takes = matches!(
        arg.get_action(),
        ArgAction::SetTrue | ArgAction::Set | ArgAction::Append
    );
    // What is hidden is said by one command to another.
    let is_shown = !arg.is_hide_set();
    !arg.is_positional() && !arg.is_required_set() && is_shown && takes && !names_a_file
}

impl Vocabulary for FlagVocabulary {
    fn keys(&self) -> Vec<&str> {
        self.flags.iter().map(|flag| flag.key.as_str()).collect()
    }

    fn is_switch(&self, key: &str) -> Option<bool> {
        self.flag(key).map(|flag| flag.is_switch)
    }

    fn is_list(&self, key: &str) -> bool {
        self.flag(key).is_some_and(|flag| flag.is_list)
    }

    fn excludes(&self, one: &str, other: &str) -> bool {
        let names = |a: &str, b: &str| {
            self.flag(a)
                .is_some_and(|flag| flag.excludes.iter().any(|e| e == b))
        };
        one == other || names(one, other) || names(other, one)
    }

    fn check(&self, settings: &[Setting]) -> Result<(), String> {
        let words = settings.iter().filter_map(Setting::argument);
        let matches = match self.command.clone().try_get_matches_from(words) {
            Ok(matches) => matches,
            Err(error) if error.kind() == ErrorKind::MissingRequiredArgument => return Ok(()),
            Err(error) => return Err(first_sentence(&error)),
        };
        if self.flag(MARK_OF_SOLVING).is_some() {
            let solve = SolveArgs::from_arg_matches(&matches).map_err(|e| first_sentence(&e))?;
            solve.config().map_err(|e| e.to_string())?;
        }
        Ok(())
    }
}

/// The parser's reason without its advice on usage.
pub fn first_sentence(error: &clap::Error) -> String {
    let text = error.to_string();
    let reason: Vec<&str> = text
        .lines()
        .map(str::trim)
        .take_while(|line| !line.is_empty())
        .collect();
    let reason = reason.join(" ");
    reason.trim_start_matches("error: ").to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::SettingValue;

    fn set(key: &str, value: &str) -> Setting {
        Setting {
            key: key.to_owned(),
            value: SettingValue::Text(value.to_owned()),
            line: 1,
        }
    }

    #[test]
    fn a_solve_has_its_flags_but_no_files() {
        let solve = FlagVocabulary::of("solve", &["threads"]).unwrap();
        for key in ["epsilon", "technique", "no-view", "sides", "quiet"] {
            assert!(solve.is_switch(key).is_some(), "{key}");
        }
        for key in [
            "out", "threads", "scene", "help", "version", "min_area", "renew",
        ] {
            assert!(solve.is_switch(key).is_none(), "{key}");
        }
        assert_eq!(solve.is_switch("no-view"), Some(true));
        assert_eq!(solve.is_switch("epsilon"), Some(false));
        assert!(solve.excludes("passes", "converge") && solve.excludes("converge", "passes"));
        assert!(solve.excludes("epsilon", "epsilon") && !solve.excludes("epsilon", "rays"));
        let compare = FlagVocabulary::of("compare", &[]).unwrap();
        assert!(compare.is_list("techniques") && compare.is_switch("json").is_none());
        assert!(FlagVocabulary::of("nothing", &[]).is_none());
    }

    #[test]
    fn values_are_judged_as_on_the_command_line() {
        let solve = FlagVocabulary::of("solve", &[]).unwrap();
        assert_eq!(
            solve.check(&[set("epsilon", "1e-4"), set("passes", "3")]),
            Ok(())
        );
        for (settings, words) in [
            (vec![set("epsilon", "x")], "epsilon"),
            (vec![set("epsilon", "-1")], "--epsilon must be"),
            (vec![set("epsilon", "nan")], "--epsilon must be"),
            (vec![set("technique", "occlusio")], "possible values"),
            (vec![set("rays", "0")], "--rays"),
            (
                vec![set("passes", "3"), set("converge", "1e-3")],
                "cannot be used with",
            ),
        ] {
            let reason = solve.check(&settings).unwrap_err();
            assert!(reason.contains(words), "{reason}");
            assert!(
                !reason.contains('\n') && !reason.contains("--help"),
                "{reason}"
            );
        }
    }
}
