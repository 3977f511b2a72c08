//! A folder that holds a solve already: `--resume` does not solve again, and makes anew only what is missing beside the
//! solution or was made with other options. Another solve than the one asked for is not overwritten.

use super::args::SolveCommand;
use super::checkpointing::has_checkpoint;
use super::error::CliError;
use super::folder_lock::FolderLock;
use super::output_files::{asked_outputs, write_outputs};
use super::session::Session;
use crate::output::{
    Fingerprint, HashText, OutputError, OutputsBlock, Staging, file_hash, read_outputs, read_ply,
    replace_outputs, write_text,
};
use serde::Deserialize;
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// The finished solve in a folder.
pub struct FinishedSolve {
    /// The bytes of its `stats.json`.
    stats: Vec<u8>,
    /// What its files were made with.
    outputs: OutputsBlock,
}

impl FinishedSolve {
    /// Finds the solve of this fingerprint in `folder`, whole and with no later one begun.
    pub fn find(folder: &Path, fingerprint: &Fingerprint) -> Option<Self> {
        if has_checkpoint(folder) {
            return None;
        }
        let stats = fs::read(folder.join("stats.json")).ok()?;
        let tree: Value = serde_json::from_slice(&stats).ok()?;
        let content = &tree["content"];
        let is_this = tree["certilux"] == env!("CARGO_PKG_VERSION")
            && content["scene"] == fingerprint.scene
            && content["settings"] == fingerprint.settings_hash()
            && file_hash(&folder.join("solution.ply"))
                .is_ok_and(|hash| content["solution"] == hash);
        let outputs = read_outputs(&stats).ok()?;
        is_this.then_some(Self { stats, outputs })
    }

    /// Refuses a folder that holds another finished solve than that of this fingerprint. One with a checkpoint is judged by
    /// that; results that do not say what they are of are none of ours.
    ///
    /// # Errors
    /// [`CliError::Argument`] with what differs.
    pub fn refuse_another(folder: &Path, fingerprint: &Fingerprint) -> Result<(), CliError> {
        if has_checkpoint(folder) || !folder.join("solution.ply").is_file() {
            return Ok(());
        }
        let Some(difference) = difference(&folder.join("stats.json"), fingerprint) else {
            return Ok(());
        };
        Err(CliError::Argument(format!(
            "--resume: {} holds another solve, which is finished: {difference}; without --resume it is solved anew and overwritten, \
             with another --out it stays",
            folder.display()
        )))
    }

    /// Makes what `command` asks for and the folder lacks, and says so.
    pub fn complete(self, session: &Session, command: &SolveCommand) -> Result<(), CliError> {
        let folder = &command.out;
        let asked = asked_outputs(command);
        let lacking: OutputsBlock = asked
            .into_iter()
            .filter(|(name, options)| {
                self.outputs.get(name) != Some(options) || !folder.join(name).is_file()
            })
            .collect();
        if lacking.is_empty() {
            session.say(format_args!(
                "{} holds this solve already; nothing is left to do",
                folder.display()
            ));
            return Ok(());
        }
        session.say(format_args!(
            "{} holds this solution; made from it: {}",
            folder.display(),
            self.reasons(&lacking).join(", ")
        ));
        let _lock = FolderLock::take(folder)?;
        let mesh = read_ply(&folder.join("solution.ply"))?;
        let mut staging = Staging::new(folder)?;
        write_outputs(session, command, &mesh, &mut staging, |name| {
            lacking.contains_key(name)
        })?;
        let mut outputs = self.outputs;
        outputs.extend(lacking);
        let path = staging.file("stats.json")?;
        let text = replace_outputs(&self.stats, &outputs).map_err(|e| OutputError::Encoding {
            path: path.clone(),
            reason: e.to_string(),
        })?;
        write_text(&path, &text, &session.interrupted)?;
        for file in staging.publish()? {
            session.say(format_args!("wrote {}", file.display()));
        }
        Ok(())
    }

    /// Each file that is to be made, with what was different about the one before it.
    fn reasons(&self, lacking: &OutputsBlock) -> Vec<String> {
        let reason = |name: &String, options: &BTreeMap<String, String>| {
            let before = self.outputs.get(name)?;
            let changes: Vec<String> = (options.iter())
                .filter_map(|(flag, now)| {
                    let was = before.get(flag).filter(|was| *was != now)?;
                    Some(format!("--{flag} {now} instead of {was}"))
                })
                .collect();
            (!changes.is_empty()).then(|| changes.join(", "))
        };
        (lacking.iter())
            .map(|(name, options)| match reason(name, options) {
                Some(reason) => format!("{name} ({reason})"),
                None => name.clone(),
            })
            .collect()
    }
}

/// In what the solve that wrote `stats` differs from that of `fingerprint`; nothing where it is the same or not said.
fn difference(stats: &Path, fingerprint: &Fingerprint) -> Option<String> {
    #[derive(Deserialize)]
    struct Content {
        scene: HashText,
    }
    #[derive(Deserialize)]
    struct Stats {
        certilux: String,
        content: Content,
        settings: BTreeMap<String, String>,
    }
    let stats: Stats = serde_json::from_slice(&fs::read(stats).ok()?).ok()?;
    let here = env!("CARGO_PKG_VERSION");
    let version = (stats.certilux != here)
        .then(|| format!("certilux is {} there and {here} here", stats.certilux));
    let found = Fingerprint {
        scene: stats.content.scene,
        settings: stats.settings,
    };
    let differences: Vec<String> = version
        .into_iter()
        .chain(fingerprint.difference(&found))
        .collect();
    (!differences.is_empty()).then(|| differences.join("; "))
}
