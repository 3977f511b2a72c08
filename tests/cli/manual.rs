//! Completions and manual pages.

use crate::command::Folder;
use std::fs;
use std::io::Write;
use std::process::{Command, Stdio};

#[test]
fn every_shell_has_completions() {
    let folder = Folder::new();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let run = folder.line(&format!("completions {shell}"));
        run.ends_with(0, shell);
        for word in ["epsilon", "batch", "no-view"] {
            assert!(run.stdout.contains(word), "{shell}: {word}");
        }
    }
    folder.line("completions tcsh").ends_with(2, "tcsh");
}

/// What bash makes of the script: it knows the flags of a command by their beginning.
#[test]
fn bash_completes() {
    let script = Folder::new().line("completions bash").stdout;
    let Ok(mut bash) = Command::new("bash")
        .args(["--norc", "--noprofile", "-s"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
    else {
        eprintln!("no bash here");
        return;
    };
    let ask = "COMP_WORDS=(certilux solve --eps); COMP_CWORD=2; _certilux certilux --eps solve; echo \"<${COMPREPLY[*]}>\"\n";
    let mut input = bash.stdin.take().unwrap();
    input.write_all(script.as_bytes()).unwrap();
    input.write_all(ask.as_bytes()).unwrap();
    drop(input);
    let said = bash.wait_with_output().unwrap();
    assert_eq!(String::from_utf8_lossy(&said.stdout), "<--epsilon>\n");
}

#[test]
fn every_command_has_a_page() {
    let folder = Folder::new();
    folder.line("man --out man1").ends_with(0, "man");
    let names = folder.names("man1");
    let help = folder.line("--help").stdout;
    let commands: Vec<&str> = help
        .lines()
        .skip_while(|line| *line != "Commands:")
        .skip(1)
        .take_while(|line| !line.is_empty())
        .filter_map(|line| {
            line.strip_prefix("  ")
                .filter(|rest| !rest.starts_with(' '))
        })
        .filter_map(|line| line.split_whitespace().next())
        .filter(|name| *name != "help")
        .collect();
    assert!(commands.len() > 10, "{commands:?}");
    for command in &commands {
        assert!(
            names.contains(&format!("certilux-{command}.1")),
            "{command}: {names:?}"
        );
    }
    assert!(names.contains(&"certilux.1".to_owned()));
    assert_eq!(names.len(), commands.len() + 1);
    let page = fs::read_to_string(folder.path("man1/certilux-solve.1")).unwrap();
    for words in [".TH", "\\-\\-epsilon", "\\-\\-resume", "solution.ply"] {
        assert!(page.contains(words), "{words}");
    }
}
