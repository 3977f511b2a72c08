//! What can go wrong with Embree, with the operation that failed.

use super::shim;
use embree4_sys::RTCDevice;
use std::ffi::CStr;
use std::fmt;
use std::ptr;
use thiserror::Error;

/// The oldest library whose layouts agree with the headers that the shim accepts.
const OLDEST_VERSION: EmbreeVersion = EmbreeVersion {
    major: 4,
    minor: 3,
    patch: 0,
};

/// The version of the library that is loaded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct EmbreeVersion {
    /// 4 in 4.3.2.
    pub major: u32,
    /// 3 in 4.3.2.
    pub minor: u32,
    /// 2 in 4.3.2.
    pub patch: u32,
}

impl EmbreeVersion {
    /// From Embree's own encoding, two decimal digits a part: 40302 is 4.3.2.
    pub(super) fn from_number(number: u32) -> Self {
        Self {
            major: number / 10_000,
            minor: number / 100 % 100,
            patch: number % 100,
        }
    }

    /// Refuses libraries older than 4.3, and another major version, whose interface differs.
    pub(super) fn check(self) -> Result<Self, EmbreeError> {
        if self < OLDEST_VERSION || self.major != OLDEST_VERSION.major {
            return Err(EmbreeError::UnsupportedVersion { found: self });
        }
        Ok(self)
    }
}

impl fmt::Display for EmbreeVersion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}.{}", self.major, self.minor, self.patch)
    }
}

/// Embree's own classes of error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum EmbreeErrorKind {
    /// Embree does not say.
    Unknown,
    /// An argument was out of range.
    InvalidArgument,
    /// The operation is not allowed in this state.
    InvalidOperation,
    /// Not enough memory.
    OutOfMemory,
    /// The processor lacks the instruction set asked for.
    UnsupportedCpu,
    /// The build was cancelled.
    Cancelled,
    /// A code that 4.2's header does not know; the raw code tells.
    Other,
}

impl EmbreeErrorKind {
    fn from_code(code: i32) -> Self {
        const KINDS: [(u32, EmbreeErrorKind); 6] = [
            (shim::CERTILUX_ERROR_UNKNOWN, EmbreeErrorKind::Unknown),
            (
                shim::CERTILUX_ERROR_INVALID_ARGUMENT,
                EmbreeErrorKind::InvalidArgument,
            ),
            (
                shim::CERTILUX_ERROR_INVALID_OPERATION,
                EmbreeErrorKind::InvalidOperation,
            ),
            (
                shim::CERTILUX_ERROR_OUT_OF_MEMORY,
                EmbreeErrorKind::OutOfMemory,
            ),
            (
                shim::CERTILUX_ERROR_UNSUPPORTED_CPU,
                EmbreeErrorKind::UnsupportedCpu,
            ),
            (shim::CERTILUX_ERROR_CANCELLED, EmbreeErrorKind::Cancelled),
        ];
        KINDS
            .iter()
            .find(|(known, _)| i64::from(*known) == i64::from(code))
            .map_or(Self::Other, |(_, kind)| *kind)
    }
}

impl fmt::Display for EmbreeErrorKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Unknown => "unknown error",
            Self::InvalidArgument => "invalid argument",
            Self::InvalidOperation => "invalid operation",
            Self::OutOfMemory => "out of memory",
            Self::UnsupportedCpu => "unsupported processor",
            Self::Cancelled => "cancelled",
            Self::Other => "error",
        })
    }
}

/// An error of the Embree layer.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum EmbreeError {
    /// Embree reported an error.
    #[error("Embree could not {operation}: {kind} (code {code}){}{message}", if message.is_empty() { "" } else { ": " })]
    Reported {
        /// What was asked, to follow "could not".
        operation: &'static str,
        /// The class of error.
        kind: EmbreeErrorKind,
        /// Embree's own number.
        code: i32,
        /// Embree's own words; may be empty.
        message: String,
    },
    /// Embree returned no object, and no error either.
    #[error("Embree could not {operation}: it returned nothing and gave no reason")]
    NothingReturned {
        /// What was asked, to follow "could not".
        operation: &'static str,
    },
    /// The library loaded is too old, or of another major version.
    #[error("the Embree library is version {found}, but 4.3 or a later 4.x is needed")]
    UnsupportedVersion {
        /// Its version.
        found: EmbreeVersion,
    },
    /// A triangle refers to a vertex that is not there.
    #[error("triangle {triangle} refers to vertex {index}, but there are {vertices} vertices")]
    IndexOutOfRange {
        /// 0-based number of the triangle.
        triangle: usize,
        /// The index.
        index: u32,
        /// Number of vertices.
        vertices: usize,
    },
    /// More vertices or triangles than 32-bit ids can name.
    #[error("{count} {what} are more than 32-bit ids can name")]
    TooMany {
        /// "vertices" or "triangles".
        what: &'static str,
        /// How many there are.
        count: usize,
    },
    /// A device setting that Embree's configuration string cannot hold.
    #[error("`{isa}` is no instruction set of Embree (sse2, sse4.2, avx, avx2, avx512)")]
    UnknownInstructionSet {
        /// What was asked for.
        isa: String,
    },
}

/// Turns the calling thread's pending error of `device` (null: of device creation) into a typed
/// one. Called after each set-up operation on the thread that ran it, because Embree keeps errors
/// by thread.
///
/// # Safety
/// `device` is null or a live device.
pub(super) unsafe fn check(device: RTCDevice, operation: &'static str) -> Result<(), EmbreeError> {
    let mut message = ptr::null();
    // SAFETY: the caller vouches for the device, and `message` is a place to write a pointer to.
    let code = unsafe { shim::certilux_take_error(device, &mut message) };
    if code == shim::CERTILUX_ERROR_NONE as i32 {
        return Ok(());
    }
    let message = if message.is_null() {
        String::new()
    } else {
        // SAFETY: Embree returns a NUL-terminated string that lives until the thread's next error.
        unsafe { CStr::from_ptr(message) }
            .to_string_lossy()
            .into_owned()
    };
    Err(EmbreeError::Reported {
        operation,
        kind: EmbreeErrorKind::from_code(code),
        code,
        message,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_before_4_3_and_other_majors_are_refused() {
        for (number, text, accepted) in [
            (40_200, "4.2.0", false),
            (31_300, "3.13.0", false),
            (50_000, "5.0.0", false),
            (40_300, "4.3.0", true),
            (40_303, "4.3.3", true),
            (40_400, "4.4.0", true),
        ] {
            let version = EmbreeVersion::from_number(number);
            assert_eq!(version.to_string(), text);
            assert_eq!(version.check().is_ok(), accepted, "{text}");
            if let Err(error) = version.check() {
                assert!(error.to_string().contains(text), "{error}");
                assert!(error.to_string().contains("4.3"), "{error}");
            }
        }
    }

    #[test]
    fn a_code_that_the_old_header_lacks_is_kept() {
        let error = EmbreeError::Reported {
            operation: "open a device",
            kind: EmbreeErrorKind::from_code(7),
            code: 7,
            message: String::new(),
        };
        assert_eq!(EmbreeErrorKind::from_code(7), EmbreeErrorKind::Other);
        assert_eq!(
            error.to_string(),
            "Embree could not open a device: error (code 7)"
        );
    }
}
