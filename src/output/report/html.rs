//! Pieces of HTML: escaped text, tables, numbers as people read them.

use std::fmt::Write;

/// Text with the characters escaped that mean something in HTML, attributes included.
pub fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            // Control characters have no place in HTML.
            c if c.is_control() && c != '\n' && c != '\t' => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
    out
}

/// A whole number with thin spaces between thousands.
pub fn count(value: u64) -> String {
    let digits = value.to_string();
    let mut out = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            out.push('\u{202f}');
        }
        out.push(digit);
    }
    out
}

/// Three significant digits, or 0.
pub fn quantity(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 || !value.is_finite() {
        "0".to_owned()
    } else if (1.0e-3..1.0e6).contains(&size) {
        let decimals = (2 - size.log10().floor() as i32).clamp(0, 6);
        format!("{value:.*}", decimals as usize)
    } else {
        format!("{value:.2e}")
    }
}

/// A cell: what is shown, and the number to sort by, if it is one.
pub struct Cell {
    text: String,
    number: Option<f64>,
}

impl Cell {
    /// Text.
    pub fn text(text: &str) -> Self {
        Self {
            text: text.to_owned(),
            number: None,
        }
    }

    /// A count.
    pub fn count(value: u64) -> Self {
        Self {
            text: count(value),
            number: Some(value as f64),
        }
    }

    /// A quantity.
    pub fn quantity(value: f64) -> Self {
        Self {
            text: quantity(value),
            number: Some(value),
        }
    }

    /// A quantity that may be unknown.
    pub fn maybe(value: Option<f64>) -> Self {
        value.map_or_else(|| Self::text(""), Self::quantity)
    }
}

/// A table whose columns sort when their heads are pressed.
pub fn table(caption: &str, heads: &[&str], rows: &[Vec<Cell>]) -> String {
    let mut out = format!(
        "<div class=\"wide\"><table class=\"sortable\"><caption>{}</caption><thead><tr>",
        escaped(caption)
    );
    for (column, head) in heads.iter().enumerate() {
        // Heads stand over what they name: numbers are set to the right.
        let numbers = rows
            .iter()
            .any(|row| row.get(column).is_some_and(|c| c.number.is_some()));
        let class = if numbers { " class=\"n\"" } else { "" };
        let _ = write!(
            out,
            "<th scope=\"col\"{class}><button type=\"button\">{}</button></th>",
            escaped(head)
        );
    }
    out.push_str("</tr></thead><tbody>\n");
    for row in rows {
        out.push_str("<tr>");
        for cell in row {
            let _ = match cell.number {
                Some(n) => write!(
                    out,
                    "<td class=\"n\" data-n=\"{n}\">{}</td>",
                    escaped(&cell.text)
                ),
                None => write!(out, "<td>{}</td>", escaped(&cell.text)),
            };
        }
        out.push_str("</tr>\n");
    }
    out.push_str("</tbody></table></div>\n");
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_in_a_text_is_markup() {
        assert_eq!(
            escaped("<a href=\"x\">&'\u{7}"),
            "&lt;a href=&quot;x&quot;&gt;&amp;&#39;\u{fffd}"
        );
        let table = table("<c>", &["<h>"], &[vec![Cell::text("<t>")]]);
        assert!(!table.contains("<c>") && !table.contains("<h>") && !table.contains("<t>"));
    }

    #[test]
    fn numbers_are_short() {
        assert_eq!(count(1_234_567), "1\u{202f}234\u{202f}567");
        assert_eq!(count(12), "12");
        assert_eq!(quantity(0.012345), "0.0123");
        assert_eq!(quantity(1234.5), "1234");
        assert_eq!(quantity(1.0e-9), "1.00e-9");
        assert_eq!(quantity(f64::NAN), "0");
    }
}
