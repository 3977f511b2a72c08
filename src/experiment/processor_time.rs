//! Time that the processors spent on this program: unlike wall time it means the same on a busy machine.

use rustix::time::{ClockId, clock_gettime};

/// Processor seconds of the whole process so far, all threads together.
pub fn processor_seconds() -> f64 {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    time.tv_sec as f64 + 1.0e-9 * time.tv_nsec as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_takes_time() {
        let before = processor_seconds();
        let mut sum = 0u64;
        while processor_seconds() - before < 0.01 {
            sum = std::hint::black_box(sum + 1);
        }
        assert!(sum > 0 && processor_seconds() >= before + 0.01);
    }
}
