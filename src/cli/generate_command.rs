//! `certilux generate`: built-in scenes as files.

use super::args::GenerateCommand;
use super::error::CliError;
use super::render::make_folder;
use super::session::{Session, print_line};
use crate::output::{OutputError, write_atomically};
use crate::scene::generate::{catalogue, generate};
use std::io::Write;

/// Lists the scenes, or writes one as DIR/NAME.obj and DIR/NAME.mtl.
pub fn run(session: &Session, command: &GenerateCommand) -> Result<(), CliError> {
    let (Some(name), Some(out)) = (&command.name, &command.out) else {
        for entry in catalogue() {
            print_line(format_args!("{:<24} {}", entry.name, entry.description));
        }
        return Ok(());
    };
    let scene = generate(name)?;
    make_folder(out)?;
    for (extension, text) in [("mtl", &scene.mtl), ("obj", &scene.obj)] {
        let path = out.join(format!("{}.{extension}", scene.name));
        write_atomically(&path, &session.interrupted, |w| {
            w.write_all(text.as_bytes())
                .map_err(|e| OutputError::io("write", &path, e))
        })?;
        session.say(format_args!("{}", path.display()));
    }
    Ok(())
}
