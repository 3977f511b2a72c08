//! The state of a solve on disk, from which a killed solve goes on.
//!
//! Layout, little endian: eight bytes of magic, the layout's version (u32), the versions of certilux and of
//! Embree, the scene's hash, the settings, the state, and the SHA-256 of all bytes before it. Texts and the state
//! have their length (u64) before them. Nothing is used before everything has been checked.

use super::{Fingerprint, OutputError, write_atomically};
use crate::solve::Snapshot;
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

const MAGIC: [u8; 8] = *b"CTLXCKPT";
/// The layout described above.
const VERSION: u32 = 4;
const DIGEST_BYTES: usize = 32;

/// What made a state: another program or library may round another way.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CheckpointKey {
    /// Version of this program.
    pub certilux: String,
    /// Version of the Embree library.
    pub embree: String,
    /// Scene and settings.
    pub fingerprint: Fingerprint,
}

/// A checkpoint that cannot be used. None is ever used in part.
#[derive(Debug, thiserror::Error)]
#[error("the checkpoint {} {problem}; without --resume the solve starts anew", path.display())]
pub struct CheckpointError {
    /// The file.
    pub path: PathBuf,
    /// What is wrong with it.
    pub problem: CheckpointProblem,
}

/// What can be wrong with a checkpoint.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CheckpointProblem {
    /// The system cannot read it.
    #[error("cannot be read: {0}")]
    Unreadable(io::Error),
    /// It does not begin as one.
    #[error("is no checkpoint of certilux")]
    NotACheckpoint,
    /// A later program wrote it.
    #[error(
        "has format {found}, newer than this program's {VERSION}: use the certilux that wrote it"
    )]
    Newer {
        /// The layout's version.
        found: u32,
    },
    /// An earlier program wrote it.
    #[error(
        "has format {found}, older than this program's {VERSION}: use the certilux that wrote it, or solve anew"
    )]
    Older {
        /// The layout's version.
        found: u32,
    },
    /// Bytes are missing or not as they were written.
    #[error("is damaged: {0}")]
    Damaged(String),
    /// It is of another solve.
    #[error("belongs to another solve: {0}")]
    Foreign(String),
}

/// Writes a state beside `path` and renames it.
///
/// # Errors
/// As [`write_atomically`].
pub fn write_checkpoint(
    path: &Path,
    key: &CheckpointKey,
    snapshot: &Snapshot,
) -> Result<(), OutputError> {
    let head = encode_head(key, snapshot.as_bytes().len());
    let mut hash = Sha256::new();
    hash.update(&head);
    hash.update(snapshot.as_bytes());
    let digest = hash.finalize();
    // A pass that is done is worth keeping, whoever asks to stop meanwhile.
    write_atomically(path, &AtomicBool::new(false), |file| {
        [&head, snapshot.as_bytes(), digest.as_slice()]
            .into_iter()
            .try_for_each(|part| file.write_all(part))
            .map_err(|e| OutputError::io("write", path, e))
    })
}

/// The state in the file at `path`, or `None` where there is no file.
///
/// # Errors
/// [`CheckpointError`] for anything but a whole checkpoint of `key`.
pub fn read_checkpoint(
    path: &Path,
    key: &CheckpointKey,
) -> Result<Option<Snapshot>, CheckpointError> {
    let refuse = |problem| CheckpointError {
        path: path.to_path_buf(),
        problem,
    };
    let unreadable = |e: io::Error| refuse(CheckpointProblem::Unreadable(e));
    match std::fs::metadata(path) {
        // A link to nowhere is no absent checkpoint.
        Err(e) if e.kind() == io::ErrorKind::NotFound && !path.is_symlink() => return Ok(None),
        Err(e) => return Err(unreadable(e)),
        // Reading a pipe would wait for ever.
        Ok(found) if !found.is_file() => return Err(refuse(CheckpointProblem::NotACheckpoint)),
        Ok(_) => {}
    }
    // The beginning alone tells what is no checkpoint, however large it is.
    let mut file = std::fs::File::open(path).map_err(unreadable)?;
    let mut bytes = Vec::new();
    let head = MAGIC.len() as u64;
    (Read::by_ref(&mut file).take(head).read_to_end(&mut bytes)).map_err(unreadable)?;
    if bytes == MAGIC {
        file.read_to_end(&mut bytes).map_err(unreadable)?;
    }
    decode(bytes, key).map(Some).map_err(refuse)
}

fn encode_head(key: &CheckpointKey, snapshot_bytes: usize) -> Vec<u8> {
    let mut out = MAGIC.to_vec();
    out.extend_from_slice(&VERSION.to_le_bytes());
    let mut text = |text: &str| {
        out.extend_from_slice(&(text.len() as u64).to_le_bytes());
        out.extend_from_slice(text.as_bytes());
    };
    text(&key.certilux);
    text(&key.embree);
    text(&key.fingerprint.scene);
    let settings = &key.fingerprint.settings;
    text(&settings.len().to_string());
    for (name, value) in settings {
        text(name);
        text(value);
    }
    out.extend_from_slice(&(snapshot_bytes as u64).to_le_bytes());
    out
}

fn decode(mut bytes: Vec<u8>, key: &CheckpointKey) -> Result<Snapshot, CheckpointProblem> {
    let damaged = |what: &str| CheckpointProblem::Damaged(what.to_owned());
    if !bytes.starts_with(&MAGIC) {
        return Err(
            match bytes.len() < MAGIC.len() && MAGIC.starts_with(&bytes) {
                true => damaged("it ends too early"),
                false => CheckpointProblem::NotACheckpoint,
            },
        );
    }
    let version = bytes[MAGIC.len()..]
        .first_chunk()
        .map(|b| u32::from_le_bytes(*b));
    match version {
        None => return Err(damaged("it ends too early")),
        // Before the checksum, whose place is the other version's affair.
        Some(0) => return Err(damaged("there is no such format")),
        Some(found) if found > VERSION => return Err(CheckpointProblem::Newer { found }),
        Some(found) if found < VERSION => return Err(CheckpointProblem::Older { found }),
        Some(_) => {}
    }
    let body = bytes.len().saturating_sub(DIGEST_BYTES);
    if Sha256::digest(&bytes[..body]).as_slice() != &bytes[body..] {
        return Err(damaged("its bytes do not match its checksum"));
    }
    bytes.truncate(body);
    let mut input = Input(&bytes[MAGIC.len() + size_of::<u32>()..]);
    let made = input
        .key()
        .ok_or_else(|| damaged("its head cannot be read"))?;
    let length = input
        .length()
        .ok_or_else(|| damaged("its state has no length"))?;
    if length != input.0.len() {
        return Err(damaged("its state has another length"));
    }
    for (what, made, here) in [
        ("certilux", &made.certilux, &key.certilux),
        ("Embree", &made.embree, &key.embree),
    ] {
        if made != here {
            let text = format!("{what} {made} made it, this is {here}");
            return Err(CheckpointProblem::Foreign(text));
        }
    }
    if let Some(text) = key.fingerprint.difference(&made.fingerprint) {
        return Err(CheckpointProblem::Foreign(text));
    }
    let state = bytes.len() - length;
    bytes.drain(..state);
    Ok(Snapshot::from_bytes(bytes))
}

/// Takes parts off the front.
struct Input<'a>(&'a [u8]);

impl Input<'_> {
    fn length(&mut self) -> Option<usize> {
        let (head, tail) = self.0.split_first_chunk()?;
        self.0 = tail;
        usize::try_from(u64::from_le_bytes(*head)).ok()
    }

    fn text(&mut self) -> Option<String> {
        let length = self.length()?;
        let (head, tail) = self.0.split_at_checked(length)?;
        self.0 = tail;
        String::from_utf8(head.to_vec()).ok()
    }

    /// In the order of [`encode_head`].
    fn key(&mut self) -> Option<CheckpointKey> {
        let (certilux, embree, scene) = (self.text()?, self.text()?, self.text()?);
        let count: usize = self.text()?.parse().ok()?;
        let mut settings = BTreeMap::new();
        for _ in 0..count {
            settings.insert(self.text()?, self.text()?);
        }
        Some(CheckpointKey {
            certilux,
            embree,
            fingerprint: Fingerprint { scene, settings },
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn key() -> CheckpointKey {
        CheckpointKey {
            certilux: "0.1.0".to_owned(),
            embree: "4.3.3".to_owned(),
            fingerprint: Fingerprint {
                scene: "abcd".to_owned(),
                settings: BTreeMap::from([("epsilon".to_owned(), "1e-5".to_owned())]),
            },
        }
    }

    struct Written {
        folder: tempfile::TempDir,
        path: PathBuf,
        bytes: Vec<u8>,
    }

    fn written() -> Written {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("solve.checkpoint");
        let snapshot = Snapshot::from_bytes((0..200).collect());
        write_checkpoint(&path, &key(), &snapshot).unwrap();
        assert_eq!(read_checkpoint(&path, &key()).unwrap(), Some(snapshot));
        let bytes = fs::read(&path).unwrap();
        Written {
            folder,
            path,
            bytes,
        }
    }

    fn problem(path: &Path) -> CheckpointProblem {
        read_checkpoint(path, &key()).unwrap_err().problem
    }

    #[test]
    fn no_flipped_bit_passes() {
        let Written {
            folder: _kept,
            path,
            bytes,
        } = written();
        for at in 0..8 * bytes.len() {
            let mut flipped = bytes.clone();
            flipped[at / 8] ^= 1 << (at % 8);
            fs::write(&path, flipped).unwrap();
            let problem = problem(&path);
            let named = match at / 8 {
                0..8 => matches!(problem, CheckpointProblem::NotACheckpoint),
                8..12 => matches!(
                    problem,
                    CheckpointProblem::Newer { .. }
                        | CheckpointProblem::Older { .. }
                        | CheckpointProblem::Damaged(_)
                ),
                _ => matches!(problem, CheckpointProblem::Damaged(_)),
            };
            assert!(named, "bit {at}: {problem:?}");
        }
    }

    #[test]
    fn no_other_length_passes() {
        let Written {
            folder: _kept,
            path,
            bytes,
        } = written();
        for length in 0..bytes.len() {
            fs::write(&path, &bytes[..length]).unwrap();
            let problem = problem(&path);
            assert!(
                matches!(problem, CheckpointProblem::Damaged(_)),
                "{length}: {problem:?}"
            );
        }
        let longer: Vec<u8> = bytes.iter().chain(b"x").copied().collect();
        fs::write(&path, longer).unwrap();
        assert!(matches!(problem(&path), CheckpointProblem::Damaged(_)));
    }

    /// Another version with a right checksum is refused for what it is.
    #[test]
    fn one_of_another_version_is_called_newer_or_older() {
        let Written {
            folder: _kept,
            path,
            mut bytes,
        } = written();
        for (version, age) in [(VERSION + 1, "newer"), (VERSION - 1, "older")] {
            bytes[8..12].copy_from_slice(&version.to_le_bytes());
            let body = bytes.len() - DIGEST_BYTES;
            let digest = Sha256::digest(&bytes[..body]);
            bytes[body..].copy_from_slice(&digest);
            fs::write(&path, &bytes).unwrap();
            let text = read_checkpoint(&path, &key()).unwrap_err().to_string();
            let format = format!("format {version}, {age}");
            assert!(text.contains(&format), "{text}");
        }
    }

    #[test]
    fn one_of_another_solve_is_refused_with_the_difference() {
        let Written {
            folder: _kept,
            path,
            ..
        } = written();
        type Change = fn(&mut CheckpointKey);
        let changes: [(Change, &str); 4] = [
            (|k| k.certilux.push('0'), "certilux 0.1.0 made it"),
            (|k| k.embree.push('0'), "Embree 4.3.3 made it"),
            (|k| k.fingerprint.scene.push('0'), "another scene"),
            (
                |k| {
                    drop(
                        k.fingerprint
                            .settings
                            .insert("epsilon".into(), "2e-5".into()),
                    )
                },
                "epsilon is 1e-5 there and 2e-5 here",
            ),
        ];
        for (change, words) in changes {
            let mut other = key();
            change(&mut other);
            let error = read_checkpoint(&path, &other).unwrap_err();
            assert!(matches!(error.problem, CheckpointProblem::Foreign(_)));
            assert!(error.to_string().contains(words), "{error}");
        }
    }

    #[test]
    fn what_is_not_there_is_no_error_and_what_is_no_file_is() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("none");
        assert_eq!(read_checkpoint(&path, &key()).unwrap(), None);
        assert!(matches!(
            problem(folder.path()),
            CheckpointProblem::NotACheckpoint
        ));
        fs::write(&path, b"# a note\n").unwrap();
        assert!(matches!(problem(&path), CheckpointProblem::NotACheckpoint));
        fs::write(&path, b"").unwrap();
        assert!(matches!(problem(&path), CheckpointProblem::Damaged(_)));
    }
}
