//! `certilux batch`: many solves, each a process of its own, so that none takes the others with it.

use super::batch_args::BatchCommand;
use super::batch_child::{Child, Ending};
use super::batch_progress::BatchProgress;
use super::byte_size::ByteSize;
use super::defaults::defaults_of;
use super::error::CliError;
use super::file_plan::FilePlan;
use super::flag_vocabulary::FlagVocabulary;
use super::logs;
use super::result_paths::make_result_folder;
use super::session::{Session, print_line};
use crate::job::{
    BatchCounts, BatchFile, Job, JobRecord, JobStatus, SettingValue, nearest, read_job_list,
};
use crate::output::write_json;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Flags of `solve` that are the batch's affair, and debugging, which keeps no checkpoint.
const RESERVED: [&str; 7] = [
    "threads",
    "max-memory",
    "resume",
    "quiet",
    "json-logs",
    "no-config",
    "check-claims",
];
/// Threads for which one job is enough: a solve spreads over them, its loading and writing do not.
const THREADS_A_JOB: usize = 4;
/// What became of the jobs.
const RECORD: &str = "batch.json";
/// Time between two looks at the jobs.
const PATIENCE: Duration = Duration::from_millis(20);
/// Time that jobs are given to stop by themselves: they ask every few hundred microseconds.
const GRACE: Duration = Duration::from_secs(20);
/// Least time between two writes of `batch.json` while jobs run.
const BETWEEN_RECORDS: Duration = Duration::from_secs(1);
/// Failed jobs that the last message names.
const MOST_NAMED: usize = 20;

/// Runs the jobs of a list.
pub fn run(session: &Session, command: &BatchCommand, is_plain: bool) -> Result<(), CliError> {
    let vocabulary = FlagVocabulary::of("solve", &RESERVED)
        .ok_or_else(|| CliError::System("there is no command solve".to_owned()))?;
    let base = match is_plain {
        true => Vec::new(),
        false => defaults_of("solve", &vocabulary)?,
    };
    let mut jobs = read_job_list(&command.list, &base, &vocabulary)?;
    if command.list_names {
        for job in &jobs {
            print_line(format_args!("{}", job.name));
        }
        return Ok(());
    }
    choose(&mut jobs, &command.only)?;
    FilePlan::default()
        .reads("JOBS.toml", [&command.list])
        .writes_into("--out", &command.out, [RECORD])
        .check()?;
    make_result_folder(&command.out, &[RECORD])?;
    Batch::new(session, command, jobs).run()
}

/// Leaves the jobs of these names; all where there are none.
fn choose(jobs: &mut Vec<Job>, only: &[String]) -> Result<(), CliError> {
    for name in only {
        if !jobs.iter().any(|job| job.name == *name) {
            let names = jobs.iter().map(|job| job.name.as_str());
            let hint =
                nearest(name, names).map_or_else(String::new, |n| format!("; did you mean {n:?}?"));
            return Err(CliError::Argument(format!(
                "--only {name}: no job is called so{hint}"
            )));
        }
    }
    jobs.retain(|job| only.is_empty() || only.contains(&job.name));
    Ok(())
}

/// A batch under way.
struct Batch<'a> {
    session: &'a Session,
    command: &'a BatchCommand,
    jobs: Vec<Job>,
    file: BatchFile,
    began: Instant,
    recorded: Option<Instant>,
}

/// A job under way.
struct Running {
    index: usize,
    slot: usize,
    child: Child,
}

impl<'a> Batch<'a> {
    fn new(session: &'a Session, command: &'a BatchCommand, jobs: Vec<Job>) -> Self {
        let processors = std::thread::available_parallelism().map_or(1, usize::from);
        let threads = match command.threads {
            0 => processors,
            n => n,
        };
        let at_once = match command.jobs {
            0 => threads.div_ceil(THREADS_A_JOB),
            n => n,
        };
        let jobs_at_once = at_once.clamp(1, jobs.len().max(1));
        let records = jobs.iter().map(|job| record(job, &command.out)).collect();
        Self {
            session,
            command,
            jobs,
            file: BatchFile {
                format: BatchFile::FORMAT,
                certilux: env!("CARGO_PKG_VERSION").to_owned(),
                command: session.words.clone(),
                jobs_at_once,
                threads,
                finished: false,
                counts: BatchCounts::default(),
                seconds: 0.0,
                jobs: records,
            },
            began: Instant::now(),
            recorded: None,
        }
    }

    fn run(mut self) -> Result<(), CliError> {
        let progress = BatchProgress::new(self.session.quiet, self.jobs.len());
        self.record(true)?;
        let mut running: Vec<Running> = Vec::new();
        let mut next = 0;
        while next < self.jobs.len() || !running.is_empty() {
            if self.session.interrupted.load(Ordering::Relaxed) {
                self.stop(&mut running);
                self.record(true)?;
                return Err(self.stopped());
            }
            while running.len() < self.file.jobs_at_once && next < self.jobs.len() {
                if let Some(started) = self.start(next, &running) {
                    running.push(started);
                } else {
                    progress.ended(&self.file.jobs[next]);
                }
                next += 1;
            }
            running.retain_mut(|job| match job.child.ending() {
                None => true,
                Some(ending) => {
                    self.end(job.index, ending);
                    progress.ended(&self.file.jobs[job.index]);
                    false
                }
            });
            progress.running(running.iter().map(|job| self.jobs[job.index].name.as_str()));
            self.record(false).unwrap_or_else(|error| {
                // The last write tells whether it matters.
                logs::warn(format_args!("{error}"));
            });
            std::thread::sleep(PATIENCE);
        }
        progress.finish();
        self.file.finished = true;
        self.record(true)?;
        self.summary()
    }

    /// Starts a job; nothing where it fails at once.
    fn start(&mut self, index: usize, running: &[Running]) -> Option<Running> {
        let at_once = self.file.jobs_at_once;
        let is_free = |slot: &usize| running.iter().all(|job| job.slot != *slot);
        let slot = (0..at_once).find(is_free)?;
        // What does not divide goes to the first.
        let extra = usize::from(slot < self.file.threads % at_once);
        let threads = (self.file.threads / at_once + extra).max(1);
        let record = &mut self.file.jobs[index];
        record.threads = Some(threads);
        let words = self.words(index, threads);
        let folder = self.folder(index);
        match Child::start(&words, &folder, self.command.resume) {
            Ok(child) => {
                self.file.jobs[index].status = JobStatus::Running;
                Some(Running { index, slot, child })
            }
            Err(error) => {
                let record = &mut self.file.jobs[index];
                record.status = JobStatus::Failed;
                record.error = Some(error);
                None
            }
        }
    }

    fn folder(&self, index: usize) -> PathBuf {
        self.command.out.join(&self.jobs[index].name)
    }

    /// The words of a job's own command line.
    fn words(&self, index: usize, threads: usize) -> Vec<String> {
        let job = &self.jobs[index];
        let mut words = vec!["--no-config".to_owned(), "--quiet".to_owned()];
        if logs::as_json() {
            words.push("--json-logs".to_owned());
        }
        words.push("solve".to_owned());
        words.extend(job.settings.iter().filter_map(|s| s.argument()));
        words.push(format!("--threads={threads}"));
        if let Some(ByteSize(bytes)) = self.command.max_memory {
            let share = (bytes / self.file.jobs_at_once as u64).max(1);
            words.push(format!("--max-memory={share}"));
        }
        if self.command.resume {
            // The list says what belongs into the folders.
            words.extend(["--resume", "--renew"].map(str::to_owned));
        }
        words.push(format!("--out={}", self.folder(index).display()));
        words.push("--".to_owned());
        words.push(job.scene.clone());
        words
    }

    fn end(&mut self, index: usize, ending: Ending) {
        let record = &mut self.file.jobs[index];
        record.seconds = Some(ending.seconds);
        record.exit_code = ending.code;
        record.signal = ending.signal;
        record.status = match ending.code {
            Some(0) if self.command.resume && !ending.has_written => JobStatus::Skipped,
            Some(0) => JobStatus::Done,
            _ => {
                record.error = Some(ending.reason());
                JobStatus::Failed
            }
        };
        tracing::info!(
            job = record.name,
            status = ?record.status,
            seconds = ending.seconds,
            "job ended"
        );
    }

    /// Asks all running jobs to stop, and waits for them.
    fn stop(&mut self, running: &mut Vec<Running>) {
        for job in running.iter() {
            job.child.ask_to_stop();
        }
        let asked = Instant::now();
        while !running.is_empty() {
            running.retain_mut(|job| {
                if asked.elapsed() > GRACE {
                    job.child.kill();
                }
                let Some(ending) = job.child.ending() else {
                    return true;
                };
                self.end(job.index, ending);
                let record = &mut self.file.jobs[job.index];
                // One may have ended by itself meanwhile.
                if record.status == JobStatus::Failed {
                    record.status = JobStatus::Interrupted;
                    record.error = None;
                }
                false
            });
            std::thread::sleep(PATIENCE);
        }
    }

    /// Writes `batch.json`, if it is time or `now`.
    fn record(&mut self, now: bool) -> Result<(), CliError> {
        self.file.count();
        if !self.command.only.is_empty() {
            return Ok(());
        }
        if !now
            && self
                .recorded
                .is_some_and(|at| at.elapsed() < BETWEEN_RECORDS)
        {
            return Ok(());
        }
        self.recorded = Some(Instant::now());
        self.file.seconds = self.began.elapsed().as_secs_f64();
        // An interruption is no reason to leave it unwritten: it says what was interrupted.
        let path = self.command.out.join(RECORD);
        Ok(write_json(&path, &self.file, &AtomicBool::new(false))?)
    }

    fn stopped(&self) -> CliError {
        let counts = &self.file.counts;
        CliError::Stopped(format!(
            "interrupted: of {} jobs {} were done, {} had failed, {} were stopped, {} had not begun; the same command with --resume goes on",
            counts.total,
            counts.done + counts.skipped,
            counts.failed,
            counts.interrupted,
            counts.waiting
        ))
    }

    fn summary(mut self) -> Result<(), CliError> {
        self.file.count();
        let counts = &self.file.counts;
        self.session.say(format_args!(
            "{} jobs: {} done, {} skipped, {} failed; {:.1} s, {} at once on {} threads",
            counts.total,
            counts.done,
            counts.skipped,
            counts.failed,
            self.began.elapsed().as_secs_f64(),
            self.file.jobs_at_once,
            self.file.threads
        ));
        let failed: Vec<&JobRecord> = (self.file.jobs.iter())
            .filter(|job| job.status == JobStatus::Failed)
            .collect();
        if failed.is_empty() {
            return Ok(());
        }
        let mut text = format!("{} of {} jobs failed:", failed.len(), counts.total);
        for job in failed.iter().take(MOST_NAMED) {
            let reason = job.error.as_deref().unwrap_or_default();
            text.push_str(&format!(
                "\n  {}: {}",
                job.name,
                reason.replace('\n', "\n    ")
            ));
        }
        if failed.len() > MOST_NAMED {
            text.push_str(&format!(
                "\n  and {} more; batch.json has all",
                failed.len() - MOST_NAMED
            ));
        }
        Err(CliError::CheckFailed(text))
    }
}

fn record(job: &Job, out: &Path) -> JobRecord {
    let text = |value: &SettingValue| match value {
        SettingValue::On => "true".to_owned(),
        SettingValue::Off => "false".to_owned(),
        SettingValue::Text(text) => text.clone(),
    };
    let settings = job.settings.iter().map(|s| (s.key.clone(), text(&s.value)));
    JobRecord {
        name: job.name.clone(),
        scene: job.scene.clone(),
        out: out.join(&job.name).display().to_string(),
        settings: settings.collect(),
        status: JobStatus::Waiting,
        threads: None,
        seconds: None,
        exit_code: None,
        signal: None,
        error: None,
    }
}
