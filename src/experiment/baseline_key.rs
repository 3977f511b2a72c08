//! What the counts of a baseline depend on besides the code.

use crate::math::hash_u64;
use serde::{Deserialize, Serialize};

/// What counts and instructions depend on besides the code.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct BaselineKey {
    /// Version of Embree.
    pub embree: String,
    /// Instruction set that Embree was told to use.
    pub isa: String,
    /// Family of processors.
    pub arch: String,
    /// Fingerprint of the mathematical functions of the system's library.
    pub libm: String,
    /// Fingerprint of the processor's estimate of reciprocals, from which Embree works out where a ray hits. Empty in
    /// baselines of earlier versions.
    #[serde(default)]
    pub reciprocal: String,
}

impl BaselineKey {
    /// Of this machine, with this version of Embree told to use `isa`.
    pub fn here(embree: String, isa: &str) -> Self {
        Self {
            embree,
            isa: isa.to_owned(),
            arch: std::env::consts::ARCH.to_owned(),
            libm: libm_fingerprint(),
            reciprocal: reciprocal_fingerprint(),
        }
    }
}

/// A hash of what the library's inexact functions return over their ranges: versions of it, and the variants that it
/// chooses by processor, round some of these differently.
fn libm_fingerprint() -> String {
    let mut hash = 0_u64;
    let mut add = |x: f32| hash = hash_u64(hash ^ u64::from(x.to_bits()));
    for i in 0..4096_u16 {
        let x = f32::from(i) / 4096.0;
        add(x.acos());
        add((2.0 * x - 1.0).atan2(x));
        add((7.0 * x).sin());
        add((7.0 * x).cos());
        add(x.powf(2.4));
    }
    format!("{hash:016x}")
}

/// A hash of what the processor estimates reciprocals to be: each maker's table is another, within the same error.
#[cfg(target_arch = "x86_64")]
fn reciprocal_fingerprint() -> String {
    use pulp::{f32x4, x86::V1};
    let Some(simd) = V1::try_new() else {
        return String::new();
    };
    let hash = (0..4096_u16).fold(0_u64, |hash, i| {
        let x = 1.0 + f32::from(i) / 4096.0;
        let estimate = simd.approx_reciprocal_f32x4(f32x4(x, x, x, x)).0;
        hash_u64(hash ^ u64::from(estimate.to_bits()))
    });
    format!("{hash:016x}")
}

/// Other families of processors have one estimate each, which their name stands for.
#[cfg(not(target_arch = "x86_64"))]
fn reciprocal_fingerprint() -> String {
    String::new()
}

/// The compiler that built this program, as it names itself; instructions depend on it.
pub const COMPILER: &str = env!("CERTILUX_RUSTC");

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_key_of_a_machine_is_always_the_same() {
        let here = BaselineKey::here("4.3.3".to_owned(), "avx2");
        assert_eq!(here, BaselineKey::here("4.3.3".to_owned(), "avx2"));
        assert_ne!(here, BaselineKey::here("4.4.0".to_owned(), "avx2"));
        assert!(COMPILER.starts_with("rustc "), "{COMPILER}");
    }

    #[test]
    fn a_key_of_another_processor_or_without_one_is_foreign() {
        let here = BaselineKey::here("4.4.0".to_owned(), "avx2");
        assert_eq!(here.reciprocal.is_empty(), here.arch != "x86_64");
        let mut written = serde_json::to_value(&here).unwrap();
        let read = |value: &serde_json::Value| -> BaselineKey {
            serde_json::from_value(value.clone()).unwrap()
        };
        assert_eq!(read(&written), here);
        written["reciprocal"] = "0123456789abcdef".into();
        assert_ne!(read(&written), here);
        // Written by an earlier version.
        written.as_object_mut().unwrap().remove("reciprocal");
        assert_eq!(read(&written).reciprocal, "");
    }
}
