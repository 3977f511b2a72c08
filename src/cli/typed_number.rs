//! Numbers as typed, with the reason where one is refused.

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
