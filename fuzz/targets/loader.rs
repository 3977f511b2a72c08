//! Any bytes as OBJ and MTL: a scene or typed errors, never a panic.

#![no_main]

use certilux::scene::{LoadConfig, load_text};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    // The library, if there is one, follows the first zero byte.
    let end = data.iter().position(|&b| b == 0).unwrap_or(data.len());
    let (obj, rest) = data.split_at(end);
    let mtl = rest.get(1..).unwrap_or_default();
    let files = [("m", mtl)];
    match load_text("fuzz", obj, &files, &LoadConfig::default()) {
        Ok(scene) => {
            let bounds = scene.bounds();
            assert!(bounds.min.is_finite() && bounds.max.is_finite());
            assert!(bounds.min.abs().max(bounds.max.abs()).max_element() <= 0.5 + 1.0e-6);
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
});
