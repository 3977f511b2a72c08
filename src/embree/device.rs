//! The Embree device: configuration, version, errors, life time.

use super::error::{EmbreeError, EmbreeVersion, check};
use embree4_sys as sys;
use std::ffi::CString;
use std::sync::{Mutex, PoisonError};

/// Instruction sets that Embree's `isa=` understands.
const INSTRUCTION_SETS: [&str; 5] = ["sse2", "sse4.2", "avx", "avx2", "avx512"];

/// How to open a device.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct DeviceConfig {
    /// Threads that build a scene; `None` is one. Queries run on the caller's threads whatever
    /// stands here. Embree's high-quality build is not deterministic beyond one thread.
    pub threads: Option<usize>,
    /// Most capable instruction set to use (`sse2`, `sse4.2`, `avx`, `avx2`, `avx512`); `None` is
    /// the processor's best. Answers for grazing rays depend on it, so suites that compare bits
    /// name one.
    pub isa: Option<&'static str>,
}

impl DeviceConfig {
    /// In the form that `rtcNewDevice` reads.
    fn to_embree(self) -> Result<String, EmbreeError> {
        let mut text = format!("threads={}", self.threads.unwrap_or(1).max(1));
        if let Some(isa) = self.isa {
            if !INSTRUCTION_SETS.contains(&isa) {
                return Err(EmbreeError::UnknownInstructionSet {
                    isa: isa.to_owned(),
                });
            }
            text.push_str(",isa=");
            text.push_str(isa);
        }
        Ok(text)
    }
}

/// The devices of this process, which stay open until it ends. Once a second one was opened beside a first, a thread of
/// Embree's task scheduler (TBB) spun until the process ended, whatever `threads=1` says: a solve that wrote a picture took
/// 4.4 seconds of processor time instead of 2.4 (Embree 4.4.0).
static OPEN: Mutex<Vec<(DeviceConfig, Device)>> = Mutex::new(Vec::new());

/// An open device; clones share it.
#[derive(Debug)]
pub struct Device {
    handle: sys::RTCDevice,
    version: EmbreeVersion,
}

// SAFETY: Embree documents devices as usable from any thread, its reference count is atomic, and
// the handle is never handed out for anything else.
unsafe impl Send for Device {}
// SAFETY: as above; `&Device` allows retaining, creating scenes and reading a property, which Embree
// allows at the same time from several threads. Errors are kept by thread.
unsafe impl Sync for Device {}

impl Device {
    /// The process's device of this configuration; opened, and the library's version checked, when it is first asked for.
    pub fn new(config: &DeviceConfig) -> Result<Self, EmbreeError> {
        // Nothing is left half done by a panic: devices are only added.
        let mut devices = OPEN.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, device)) = devices.iter().find(|(of, _)| of == config) {
            return Ok(device.clone());
        }
        let device = Self::open(config)?;
        devices.push((*config, device.clone()));
        Ok(device)
    }

    pub(super) fn open(config: &DeviceConfig) -> Result<Self, EmbreeError> {
        const OPERATION: &str = "open a device";
        let text = CString::new(config.to_embree()?).expect("the settings contain no NUL");
        // SAFETY: the string is NUL-terminated and lives until the call returns.
        let handle = unsafe { sys::rtcNewDevice(text.as_ptr()) };
        if handle.is_null() {
            // SAFETY: a null device asks for the thread's error of device creation.
            unsafe { check(handle, OPERATION) }?;
            return Err(EmbreeError::NothingReturned {
                operation: OPERATION,
            });
        }
        // Owned from here on, so that every error path below releases it.
        let mut device = Self {
            handle,
            version: EmbreeVersion::from_number(0),
        };
        device.check(OPERATION)?;
        // SAFETY: the device is live.
        let number = unsafe { sys::rtcGetDeviceProperty(handle, sys::RTCDeviceProperty::VERSION) };
        device.check("read its version")?;
        device.version =
            EmbreeVersion::from_number(u32::try_from(number).unwrap_or_default()).check()?;
        Ok(device)
    }

    /// The version of the library.
    pub fn version(&self) -> EmbreeVersion {
        self.version
    }

    pub(super) fn handle(&self) -> sys::RTCDevice {
        self.handle
    }

    /// The calling thread's pending error, if any.
    pub(super) fn check(&self, operation: &'static str) -> Result<(), EmbreeError> {
        // SAFETY: the device is live as long as `self`.
        unsafe { check(self.handle, operation) }
    }
}

impl Clone for Device {
    fn clone(&self) -> Self {
        // SAFETY: the device is live; the new reference is released by the clone's `drop`.
        unsafe { sys::rtcRetainDevice(self.handle) };
        Self {
            handle: self.handle,
            version: self.version,
        }
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        // SAFETY: `self` owns one reference and gives it back once.
        unsafe { sys::rtcReleaseDevice(self.handle) };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::embree::EmbreeErrorKind;

    #[test]
    fn a_configuration_has_one_device() {
        let open = |isa| {
            let threads = None;
            Device::new(&DeviceConfig { threads, isa }).unwrap()
        };
        assert_eq!(open(None).handle(), open(None).handle());
        assert_ne!(open(None).handle(), open(Some("sse4.2")).handle());
    }

    #[test]
    fn opens_and_reports_a_supported_version() {
        let device = Device::new(&DeviceConfig::default()).unwrap();
        assert_eq!(device.version().major, 4);
        assert!(device.version().minor >= 3);
        let clone = device.clone();
        drop(device);
        assert_eq!(clone.version().to_string().split('.').count(), 3);
        clone.check("do nothing").unwrap();
    }

    #[test]
    fn an_unknown_instruction_set_is_a_typed_error() {
        let error = Device::new(&DeviceConfig {
            isa: Some("avx3,threads=9"),
            ..DeviceConfig::default()
        })
        .unwrap_err();
        assert!(matches!(error, EmbreeError::UnknownInstructionSet { .. }));
        assert!(error.to_string().contains("avx3"));
    }

    #[test]
    fn a_failing_operation_is_reported_once_with_its_name_and_code() {
        let device = Device::new(&DeviceConfig::default()).unwrap();
        // SAFETY: the device is live; Embree checks the scene for null and reports it.
        let scene = unsafe { sys::rtcNewScene(device.handle()) };
        // SAFETY: an unused geometry id is an error that Embree reports; the scene is live.
        unsafe { sys::rtcDetachGeometry(scene, 7) };
        let error = device.check("detach a geometry").unwrap_err();
        // SAFETY: this reference was made above.
        unsafe { sys::rtcReleaseScene(scene) };
        let EmbreeError::Reported {
            operation,
            kind,
            code,
            ..
        } = error
        else {
            panic!("{error}");
        };
        assert_eq!(operation, "detach a geometry");
        assert_ne!(code, 0);
        assert!(matches!(
            kind,
            EmbreeErrorKind::InvalidArgument | EmbreeErrorKind::InvalidOperation
        ));
        device.check("do nothing").unwrap();
    }
}
