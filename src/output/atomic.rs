//! Files that are either whole or absent: written beside their name, then renamed.

use super::OutputError;
use std::ffi::OsString;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

/// Bytes gathered before a write: large enough that the calls do not show in a profile.
const BUFFER_BYTES: usize = 1 << 20;

/// Ends the name of a file that is still being written.
const PARTIAL_SUFFIX: &str = ".partial";

/// The stream handed to the writer of a file.
pub type FileWriter = BufWriter<File>;

/// Removes the unfinished file unless it was renamed in time.
struct Unfinished {
    path: PathBuf,
    renamed: bool,
}

impl Drop for Unfinished {
    fn drop(&mut self) {
        if !self.renamed {
            // The error that led here is what the user must see; a file that cannot be removed
            // still carries the name that says it is unfinished.
            let _ = fs::remove_file(&self.path);
        }
    }
}

/// Writes `path` by `body`: into `NAME.partial` in the same folder, flushed to the disk, then
/// renamed. A file that stood there before is replaced at once or, on any failure, left alone;
/// the unfinished file is removed on failure, on a panic, and when `interrupted` is raised.
///
/// # Errors
/// [`OutputError::Io`] with the system's reason, [`OutputError::NotARegularFile`] when the name
/// is taken by something that is not a file, [`OutputError::Interrupted`].
pub fn write_atomically(
    path: &Path,
    interrupted: &AtomicBool,
    body: impl FnOnce(&mut FileWriter) -> Result<(), OutputError>,
) -> Result<(), OutputError> {
    let stop = || -> Result<(), OutputError> {
        if interrupted.load(Ordering::Relaxed) {
            return Err(OutputError::Interrupted {
                path: path.to_path_buf(),
            });
        }
        Ok(())
    };
    stop()?;
    // Renaming onto /dev/null or a pipe would replace it for every program of the machine.
    if fs::metadata(path).is_ok_and(|m| !m.is_file()) {
        return Err(OutputError::NotARegularFile {
            path: path.to_path_buf(),
        });
    }
    let partial = partial_path(path)?;
    let file = create_partial(&partial).map_err(|e| OutputError::io("write", path, e))?;
    let mut unfinished = Unfinished {
        path: partial,
        renamed: false,
    };
    fill(file, path, body)?;
    stop()?;
    fs::rename(&unfinished.path, path).map_err(|e| OutputError::io("rename to", path, e))?;
    unfinished.renamed = true;
    sync_folder(path);
    Ok(())
}

/// Runs `body` on a buffered `file`, then flushes it to the disk. `path` is for messages.
fn fill(
    file: File,
    path: &Path,
    body: impl FnOnce(&mut FileWriter) -> Result<(), OutputError>,
) -> Result<(), OutputError> {
    let failed = |e| OutputError::io("write", path, e);
    let mut writer = BufWriter::with_capacity(BUFFER_BYTES, file);
    body(&mut writer)?;
    writer.flush().map_err(failed)?;
    let file = writer.into_inner().map_err(|e| failed(e.into_error()))?;
    file.sync_all().map_err(failed)
}

/// `NAME.partial` beside `NAME`.
fn partial_path(path: &Path) -> Result<PathBuf, OutputError> {
    let mut name: OsString = path
        .file_name()
        .ok_or_else(|| OutputError::io("write", path, io::ErrorKind::InvalidInput.into()))?
        .to_os_string();
    name.push(PARTIAL_SUFFIX);
    Ok(path.with_file_name(name))
}

/// A fresh file: what a killed run left behind goes first, so that no link is ever followed.
fn create_partial(partial: &Path) -> io::Result<File> {
    match fs::remove_file(partial) {
        Err(e) if e.kind() != io::ErrorKind::NotFound => return Err(e),
        _ => {}
    }
    OpenOptions::new()
        .write(true)
        .create_new(true)
        .open(partial)
}

/// Makes the rename itself last through a power cut where the system can; the file is complete
/// under its name either way, so a refusal is no failure.
fn sync_folder(path: &Path) {
    let folder = match path.parent() {
        Some(p) if !p.as_os_str().is_empty() => p,
        _ => Path::new("."),
    };
    if let Ok(folder) = File::open(folder) {
        let _ = folder.sync_all();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    static GO: AtomicBool = AtomicBool::new(false);

    fn bytes(path: &Path, text: &[u8]) -> Result<(), OutputError> {
        write_atomically(path, &GO, |w| {
            w.write_all(text)
                .map_err(|e| OutputError::io("write", path, e))
        })
    }

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<_> = fs::read_dir(folder)
            .unwrap()
            .map(|e| e.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn a_whole_file_appears_under_its_name_only() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.bin");
        bytes(&path, b"first").unwrap();
        bytes(&path, b"second").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"second");
        assert_eq!(names(folder.path()), ["a.bin"]);
    }

    #[test]
    fn a_failure_leaves_the_old_file_and_no_half_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.bin");
        bytes(&path, b"old").unwrap();
        let error = write_atomically(&path, &GO, |w| {
            w.write_all(&[7; 3 << 20]).unwrap();
            Err(OutputError::io(
                "write",
                &path,
                io::ErrorKind::StorageFull.into(),
            ))
        })
        .unwrap_err();
        assert!(error.to_string().contains("a.bin"), "{error}");
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(names(folder.path()), ["a.bin"]);
    }

    #[test]
    fn a_panic_leaves_no_half_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.bin");
        let caught = std::panic::catch_unwind(|| {
            write_atomically(&path, &GO, |_| panic!("planted")).unwrap();
        });
        assert!(caught.is_err());
        assert!(names(folder.path()).is_empty());
    }

    #[test]
    fn an_interruption_leaves_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.bin");
        let flag = AtomicBool::new(false);
        let error = write_atomically(&path, &flag, |w| {
            w.write_all(b"half").unwrap();
            flag.store(true, Ordering::Relaxed);
            Ok(())
        })
        .unwrap_err();
        assert!(matches!(error, OutputError::Interrupted { .. }));
        assert!(names(folder.path()).is_empty());
    }

    /// `/dev/full` takes an open and refuses every write, as a full disk does.
    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_disk_is_named_with_its_reason() {
        let full = OpenOptions::new().write(true).open("/dev/full").unwrap();
        let path = Path::new("out/solution.ply");
        let error = fill(full, path, |w| {
            w.write_all(b"a few bytes, still in the buffer")
                .map_err(|e| OutputError::io("write", path, e))
        })
        .unwrap_err();
        let OutputError::Io { source, .. } = &error else {
            panic!("{error}")
        };
        assert_eq!(source.kind(), io::ErrorKind::StorageFull);
        assert!(error.to_string().contains("out/solution.ply"), "{error}");
    }

    #[test]
    fn unwritable_names_are_typed_errors() {
        let folder = tempfile::tempdir().unwrap();
        let missing = folder.path().join("no/such/folder/a.bin");
        let error = bytes(&missing, b"x").unwrap_err();
        assert!(error.to_string().contains("no/such/folder"), "{error}");

        assert!(matches!(
            bytes(folder.path(), b"x").unwrap_err(),
            OutputError::NotARegularFile { .. }
        ));
        // The name of a file used as a folder: refused for every user, the superuser included.
        let file = folder.path().join("file");
        bytes(&file, b"x").unwrap();
        assert!(matches!(
            bytes(&file.join("a.bin"), b"x").unwrap_err(),
            OutputError::Io { .. }
        ));
    }

    #[cfg(unix)]
    #[test]
    fn a_read_only_folder_is_a_typed_error() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o555)).unwrap();
        let probe = folder.path().join("probe");
        let superuser = File::create(&probe).is_ok();
        let outcome = bytes(&folder.path().join("a.bin"), b"x");
        fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o755)).unwrap();
        if !superuser {
            assert!(matches!(outcome.unwrap_err(), OutputError::Io { .. }));
            assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
            return;
        }
        // Permissions do not bind the superuser; a folder that takes nobody's files does.
        let Some(taken_by_none) = Some(Path::new("/proc")).filter(|p| p.is_dir()) else {
            eprintln!("NOT TESTED: a folder that the superuser may not write into");
            return;
        };
        let name = taken_by_none.join("certilux.bin");
        let error = bytes(&name, b"x").unwrap_err();
        assert!(matches!(error, OutputError::Io { .. }), "{error}");
        assert!(error.to_string().contains("/proc/certilux.bin"), "{error}");
    }

    #[test]
    fn a_device_is_never_replaced() {
        assert!(matches!(
            bytes(Path::new("/dev/null"), b"x").unwrap_err(),
            OutputError::NotARegularFile { .. }
        ));
    }
}
