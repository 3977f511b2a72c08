//! Bars in SVG, drawn by hand: they need no script and print well.

use super::html::{count, escaped, quantity};
use std::fmt::Write;

/// A part of a stacked bar.
pub struct Part<'a> {
    /// What it is.
    pub label: &'a str,
    /// How much; negative counts as nothing.
    pub value: f64,
}

/// Colours that are told apart in print and by the colour-blind (Okabe and Ito 2008).
const COLOURS: [&str; 7] = [
    "#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#999999",
];

/// Width of a bar in its own units.
const WIDTH: f64 = 600.0;

/// Units of which there are whole numbers only.
const COUNTED: [&str; 2] = ["exchanges", "rays"];

/// A bar of parts that add up to a whole, with a legend that has their values (in `unit`) and shares.
pub fn stacked_bar(title: &str, unit: &str, parts: &[Part<'_>]) -> String {
    let total: f64 = parts.iter().map(|p| p.value.max(0.0)).sum();
    let mut out = format!(
        "<figure class=\"chart\"><figcaption>{}</figcaption>",
        escaped(title)
    );
    if total <= 0.0 || !total.is_finite() {
        out.push_str("<p>Nothing to show.</p></figure>\n");
        return out;
    }
    let _ = write!(
        out,
        "<svg viewBox=\"0 0 {WIDTH} 28\" role=\"img\" aria-label=\"{}\" preserveAspectRatio=\"none\">",
        escaped(title)
    );
    let amount = |value: f64| match COUNTED.contains(&unit) {
        true => count(value.max(0.0) as u64),
        false => quantity(value),
    };
    let mut at = 0.0;
    for (part, colour) in parts.iter().zip(COLOURS.iter().cycle()) {
        let width = WIDTH * part.value.max(0.0) / total;
        let _ = write!(
            out,
            "<rect x=\"{at:.2}\" y=\"0\" width=\"{width:.2}\" height=\"28\" fill=\"{colour}\"><title>{}: {} {unit}</title></rect>",
            escaped(part.label),
            amount(part.value)
        );
        at += width;
    }
    out.push_str("</svg><ul class=\"legend\">");
    for (part, colour) in parts.iter().zip(COLOURS.iter().cycle()) {
        let _ = write!(
            out,
            "<li><span style=\"background:{colour}\"></span>{} <b>{} {unit}</b> ({:.1} %)</li>",
            escaped(part.label),
            amount(part.value),
            100.0 * part.value / total
        );
    }
    out.push_str("</ul></figure>\n");
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_parts_fill_the_bar() {
        let part = |label, value| Part { label, value };
        let bar = stacked_bar("t", "W", &[part("a", 1.0), part("b", -2.0), part("c", 3.0)]);
        assert!(bar.contains("x=\"0.00\" y=\"0\" width=\"150.00\""));
        assert!(bar.contains("x=\"150.00\" y=\"0\" width=\"0.00\""));
        assert!(bar.contains("x=\"150.00\" y=\"0\" width=\"450.00\""));
        let empty = stacked_bar("t", "W", &[part("a", 0.0), part("b", f64::NAN)]);
        assert!(!empty.contains("<svg") && !empty.contains("NaN"));
    }
}
