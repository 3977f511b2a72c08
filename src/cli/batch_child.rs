//! One job's process: it outlives neither its batch nor an order to stop, and what it says goes to a log.

use std::fs::{File, OpenOptions};
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};
use std::time::{Instant, SystemTime};

/// Tells a job which batch it belongs to, by the number of its process.
pub const PARENT_VARIABLE: &str = "CERTILUX_BATCH_PARENT";

/// What a job says, in its folder.
const LOG_NAME: &str = "log.txt";
/// The file that a solve writes last.
const LAST_WRITTEN: &str = "stats.json";
/// Lines that are quoted of one that did not say why it ended.
const LAST_LINES: usize = 4;
/// Bytes of the log that may hold the reason of a failure.
const TAIL_BYTES: u64 = 8192;

/// A job under way.
pub struct Child {
    process: std::process::Child,
    began: Instant,
    folder: PathBuf,
    written_before: Option<SystemTime>,
    log_before: u64,
}

/// How a job ended.
pub struct Ending {
    /// Exit code, unless a signal ended it.
    pub code: Option<i32>,
    /// The signal that did.
    pub signal: Option<i32>,
    /// Wall time.
    pub seconds: f64,
    /// Whether it wrote results.
    pub has_written: bool,
    /// What it said last.
    said: String,
}

impl Child {
    /// Starts the program on `words`, with its log in `folder`: behind the old one with `appends`, else instead of it.
    ///
    /// # Errors
    /// What the system refused.
    pub fn start(words: &[String], folder: &Path, appends: bool) -> Result<Self, String> {
        std::fs::create_dir_all(folder)
            .map_err(|e| format!("cannot make the folder {}: {e}", folder.display()))?;
        let path = folder.join(LOG_NAME);
        let mut options = OpenOptions::new();
        options
            .create(true)
            .append(appends)
            .write(true)
            .truncate(!appends);
        let log =
            (options.open(&path)).map_err(|e| format!("cannot write {}: {e}", path.display()))?;
        let log_before = log.metadata().map_or(0, |m| m.len());
        let mut command = Command::new(own_program()?);
        command
            .args(words)
            .env(PARENT_VARIABLE, std::process::id().to_string())
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(log);
        // Ctrl-C on the terminal is for the batch, which then asks each job once.
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        Ok(Self {
            began: Instant::now(),
            written_before: written(folder),
            folder: folder.to_path_buf(),
            process: command.spawn().map_err(|e| format!("cannot start: {e}"))?,
            log_before,
        })
    }

    /// How it ended, if it has.
    pub fn ending(&mut self) -> Option<Ending> {
        let status = self.process.try_wait().ok()??;
        Some(Ending {
            code: status.code(),
            signal: signal(status),
            seconds: self.began.elapsed().as_secs_f64(),
            has_written: written(&self.folder) != self.written_before,
            said: self.said(),
        })
    }

    /// Asks it to stop cleanly.
    pub fn ask_to_stop(&self) {
        #[cfg(unix)]
        {
            use rustix::process::{Pid, Signal, kill_process};
            // One that is gone need not be asked.
            let _ = kill_process(Pid::from_child(&self.process), Signal::TERM);
        }
    }

    /// Ends it at once.
    pub fn kill(&mut self) {
        let _ = self.process.kill();
    }

    fn said(&self) -> String {
        let read = || -> std::io::Result<Vec<u8>> {
            let mut log = File::open(self.folder.join(LOG_NAME))?;
            let length = log.metadata()?.len();
            let from = self.log_before.max(length.saturating_sub(TAIL_BYTES));
            log.seek(SeekFrom::Start(from))?;
            let mut bytes = Vec::new();
            log.read_to_end(&mut bytes)?;
            Ok(bytes)
        };
        String::from_utf8_lossy(&read().unwrap_or_default()).into_owned()
    }
}

impl Drop for Child {
    fn drop(&mut self) {
        // A batch that ends for a reason of its own leaves nobody behind; one that has ended is not hurt.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

impl Ending {
    /// Why it failed, in its own words where it had any.
    pub fn reason(&self) -> String {
        let said = last_words(&self.said);
        let how = match (self.code, self.signal) {
            (Some(code), _) => format!("exit code {code}"),
            (_, Some(signal)) => format!("ended by signal {signal}"),
            _ => "ended for an unknown reason".to_owned(),
        };
        match said.is_empty() {
            true => how,
            false => format!("{said} ({how})"),
        }
    }
}

/// The error among what a run said: the sentence that names the program, or the last error of JSON lines; else, as where
/// it panicked, the last lines.
fn last_words(said: &str) -> String {
    let json_error = said.lines().rev().find_map(|line| {
        let event: serde_json::Value = serde_json::from_str(line).ok()?;
        (event["level"] == "ERROR").then(|| event["message"].as_str().map(str::to_owned))?
    });
    if let Some(message) = json_error {
        return message;
    }
    let lines: Vec<&str> = said
        .lines()
        .filter(|line| !line.trim().is_empty())
        .collect();
    let names_us =
        |line: &&str| line.starts_with("certilux: ") && !line.starts_with("certilux: warning: ");
    let from = match lines.iter().position(names_us) {
        Some(at) => at,
        None => lines.len().saturating_sub(LAST_LINES),
    };
    let text = lines[from..].join("\n");
    text.strip_prefix("certilux: ").unwrap_or(&text).to_owned()
}

fn written(folder: &Path) -> Option<SystemTime> {
    let found = std::fs::metadata(folder.join(LAST_WRITTEN)).ok()?;
    found.modified().ok()
}

#[cfg(unix)]
fn signal(status: ExitStatus) -> Option<i32> {
    std::os::unix::process::ExitStatusExt::signal(&status)
}

#[cfg(not(unix))]
fn signal(_: ExitStatus) -> Option<i32> {
    None
}

/// This program, also where its file was replaced since it started.
fn own_program() -> Result<PathBuf, String> {
    let running = Path::new("/proc/self/exe");
    match running.exists() {
        true => Ok(running.to_path_buf()),
        false => std::env::current_exe().map_err(|e| format!("cannot find this program: {e}")),
    }
}

/// Called by every run of the program: a job ends with the batch that started it, however that ended.
#[cfg(target_os = "linux")]
pub fn end_with_batch() {
    use rustix::process::{Pid, Signal, getppid, set_parent_process_death_signal};
    let Some(batch) = std::env::var(PARENT_VARIABLE)
        .ok()
        .and_then(|text| text.parse::<i32>().ok())
    else {
        return;
    };
    // What is on disk is whole at every moment, so there is nothing to say good-bye to.
    let asked = set_parent_process_death_signal(Some(Signal::KILL)).is_ok();
    if asked && getppid().map(Pid::as_raw_nonzero).map(i32::from) != Some(batch) {
        // The variable was inherited by somebody else's process, or the batch is gone already.
        let _ = set_parent_process_death_signal(None);
    }
}

/// Elsewhere a job runs to its end.
#[cfg(not(target_os = "linux"))]
pub fn end_with_batch() {}

#[cfg(test)]
mod tests {
    use super::last_words;

    #[test]
    fn the_reason_is_found_among_what_was_said() {
        for (said, want) in [
            ("", ""),
            (
                "certilux: warning: odd\ncertilux: bad.obj is wrong\n  line 3: no\n",
                "bad.obj is wrong\n  line 3: no",
            ),
            (
                "2026 INFO certilux: pass\ncertilux: no memory\n",
                "no memory",
            ),
            (
                "a\nb\nc\nthread panicked at x:\nindex out of bounds\n",
                "b\nc\nthread panicked at x:\nindex out of bounds",
            ),
            (
                "{\"level\":\"INFO\",\"message\":\"pass\"}\n{\"level\":\"ERROR\",\"message\":\"no such scene\"}\n",
                "no such scene",
            ),
        ] {
            assert_eq!(last_words(said), want, "{said}");
        }
    }
}
