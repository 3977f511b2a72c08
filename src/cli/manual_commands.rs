//! `certilux completions` and `certilux man`: both are made from the description of the command line.

use super::args::{Cli, CompletionsCommand, ManCommand};
use super::error::CliError;
use super::render::make_folder;
use super::session::{Session, print_text};
use crate::output::write_text;
use clap::CommandFactory;

/// Prints the completions of a shell.
pub fn completions(command: &CompletionsCommand) -> Result<(), CliError> {
    let mut script = Vec::new();
    clap_complete::generate(command.shell, &mut Cli::command(), "certilux", &mut script);
    print_text(&script);
    Ok(())
}

/// Writes a page for the program and one for each command.
pub fn man(session: &Session, command: &ManCommand) -> Result<(), CliError> {
    let mut cli = Cli::command();
    cli.build();
    make_folder(&command.out)?;
    let pages =
        std::iter::once(&cli).chain(cli.get_subcommands().filter(|c| c.get_name() != "help"));
    for page in pages {
        let man = clap_mangen::Man::new(page.clone()).manual("certilux");
        let mut text = Vec::new();
        man.render(&mut text)
            .map_err(|e| CliError::System(format!("cannot make a manual page: {e}")))?;
        let path = command.out.join(man.get_filename());
        write_text(&path, &String::from_utf8_lossy(&text), &session.interrupted)?;
        session.say(format_args!("wrote {}", path.display()));
    }
    Ok(())
}
