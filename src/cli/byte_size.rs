//! Amounts of memory as typed and as printed.

use std::fmt;

/// A number of bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct ByteSize(pub u64);

/// Units by their letters, each 1024 times the one before.
const UNITS: [char; 5] = ['K', 'M', 'G', 'T', 'P'];

/// Parses `512M`, `1.5G`, `2GiB`, `1000000`: letters are powers of 1024.
pub fn parse_byte_size(text: &str) -> Result<ByteSize, String> {
    let reason = || "a size such as 512M, 1.5G or 8GiB is needed (powers of 1024)".to_owned();
    let lower = text.trim().to_ascii_uppercase();
    let number = lower
        .trim_end_matches("IB")
        .trim_end_matches('B')
        .trim_end();
    let unit = number
        .chars()
        .last()
        .and_then(|c| UNITS.iter().position(|&u| u == c));
    let (digits, scale) = match unit {
        Some(power) => (&number[..number.len() - 1], 1024f64.powi(power as i32 + 1)),
        None => (number, 1.0),
    };
    match digits.trim().parse::<f64>() {
        Ok(x) if x > 0.0 && x.is_finite() && x * scale < u64::MAX as f64 => {
            Ok(ByteSize((x * scale) as u64))
        }
        _ => Err(reason()),
    }
}

impl fmt::Display for ByteSize {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut size = self.0 as f64;
        let mut unit = None;
        for letter in UNITS {
            // From 1000 on, so that no four digits are printed.
            if size < 1000.0 {
                break;
            }
            size /= 1024.0;
            unit = Some(letter);
        }
        match unit {
            None => write!(f, "{} B", self.0),
            Some(letter) if size < 10.0 => write!(f, "{size:.1} {letter}iB"),
            Some(letter) => write!(f, "{size:.0} {letter}iB"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_powers_of_1024() {
        for (text, bytes) in [
            ("1", 1),
            ("512M", 512 << 20),
            ("1.5G", 3 << 29),
            ("2GiB", 2 << 30),
            ("8gb", 8 << 30),
            ("3 K", 3072),
            ("100B", 100),
        ] {
            assert_eq!(parse_byte_size(text), Ok(ByteSize(bytes)), "{text}");
        }
        for text in [
            "", "G", "-1G", "0", "nan", "infG", "1X", "1e30T", "1GG", "é",
        ] {
            assert!(parse_byte_size(text).is_err(), "{text}");
        }
    }

    #[test]
    fn sizes_are_printed_short() {
        for (bytes, text) in [
            (12, "12 B"),
            (1 << 20, "1.0 MiB"),
            (1023 << 20, "1.0 GiB"),
            (50 << 30, "50 GiB"),
        ] {
            assert_eq!(ByteSize(bytes).to_string(), text);
        }
    }
}
