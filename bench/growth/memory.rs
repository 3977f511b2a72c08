//! Resident memory of this process, from Linux.

use std::fs;

/// Forgets the greatest memory so far: the next peak is that of what follows.
pub fn reset_peak() -> Result<(), String> {
    // 5: "reset the peak resident set size to the current one" (proc(5)).
    fs::write("/proc/self/clear_refs", "5").map_err(|e| format!("/proc/self/clear_refs: {e}"))
}

/// Greatest resident memory since the last reset, in bytes.
pub fn peak() -> Result<u64, String> {
    let status =
        fs::read_to_string("/proc/self/status").map_err(|e| format!("/proc/self/status: {e}"))?;
    let kilobytes = status.lines().find_map(|line| {
        line.strip_prefix("VmHWM:")?
            .trim()
            .strip_suffix("kB")?
            .trim()
            .parse::<u64>()
            .ok()
    });
    kilobytes
        .map(|k| 1024 * k)
        .ok_or_else(|| "no VmHWM in /proc/self/status".to_owned())
}
