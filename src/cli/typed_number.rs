//! Numbers as typed, with the reason where one is refused.

use std::str::FromStr;

/// A finite number.
pub fn parse_finite(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x.is_finite() => Ok(x),
        Ok(_) => Err("a finite number is needed".to_owned()),
        Err(e) => Err(e.to_string()),
    }
}

/// Zero or a positive finite number.
pub fn parse_bound(text: &str) -> Result<f64, String> {
    match parse_finite(text)? {
        x if x >= 0.0 => Ok(x),
        _ => Err("zero or a positive number is needed".to_owned()),
    }
}

/// A positive finite number.
pub fn parse_positive(text: &str) -> Result<f64, String> {
    match parse_finite(text)? {
        x if x > 0.0 => Ok(x),
        _ => Err("a positive number is needed".to_owned()),
    }
}

/// A whole number, such as a count or a seed.
pub fn parse_whole<T: FromStr>(text: &str) -> Result<T, String> {
    let reason = "a whole number from 0 is needed, and not above what 64 bits hold";
    text.parse().map_err(|_| reason.to_owned())
}
