//! Work in quantity: what a job list says, what became of each job, what a solve is going to need.

mod batch_file;
mod grid;
mod job_list;
mod job_name;
mod memory_estimate;
mod nearest;
mod setting;
mod settings_file;
mod toml_source;

pub use batch_file::{BatchCounts, BatchFile, JobRecord, JobStatus};
pub use job_list::{Job, read_job_list};
pub use memory_estimate::MemoryEstimate;
pub use nearest::nearest;
pub use setting::{Setting, SettingValue, Vocabulary, override_settings};
pub use settings_file::{SettingsFile, read_settings_file};
pub use toml_source::TomlError;
