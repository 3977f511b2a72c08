//! One solve a folder: two that write the same files would tear each other's.

use super::error::CliError;
use std::fs::File;
use std::path::Path;
use std::time::{Duration, Instant};

/// Time for which a solve that was killed may still be dying.
const PATIENCE: Duration = Duration::from_secs(5);
/// Time between two tries.
const BETWEEN_TRIES: Duration = Duration::from_millis(50);

/// A folder that is ours until this is dropped or the process ends, however it ends. No file is left behind.
pub struct FolderLock {
    _folder: Option<File>,
}

impl FolderLock {
    /// Locks `folder`, which exists. File systems without locks have none.
    ///
    /// # Errors
    /// [`CliError::Argument`] where another solve writes into it.
    pub fn take(folder: &Path) -> Result<Self, CliError> {
        let Ok(file) = File::open(folder) else {
            return Ok(Self { _folder: None });
        };
        let began = Instant::now();
        while !lock(&file) {
            if began.elapsed() > PATIENCE {
                return Err(CliError::Argument(format!(
                    "another solve is writing into {}",
                    folder.display()
                )));
            }
            std::thread::sleep(BETWEEN_TRIES);
        }
        Ok(Self {
            _folder: Some(file),
        })
    }
}

/// False where somebody else has the lock.
#[cfg(unix)]
fn lock(file: &File) -> bool {
    use rustix::fs::{FlockOperation, flock};
    use rustix::io::Errno;
    flock(file, FlockOperation::NonBlockingLockExclusive) != Err(Errno::WOULDBLOCK)
}

#[cfg(not(unix))]
fn lock(_: &File) -> bool {
    true
}
