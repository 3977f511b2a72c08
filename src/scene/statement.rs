//! Logical lines of OBJ and MTL text: byte order mark, any line ending, `\` continuations, Latin-1.

use super::error::Reason;
use std::borrow::Cow;

/// A logical line that is neither blank nor a comment.
pub(super) struct Statement<'a> {
    /// 1-based number of its first physical line.
    pub line: usize,
    /// First word.
    pub keyword: &'a [u8],
    /// The rest, trimmed, trailing comment included.
    text: &'a [u8],
}

impl<'a> Statement<'a> {
    /// The values: words up to a word that starts a comment.
    pub fn values(&self) -> impl Iterator<Item = &'a [u8]> + use<'a> {
        words(self.text).take_while(|w| w[0] != b'#')
    }

    /// The rest of the line as a name. A `#` may belong to it.
    pub fn name(&self) -> String {
        decode(self.text)
    }

    /// The rest of the line as it stands.
    pub fn name_bytes(&self) -> &'a [u8] {
        self.text
    }

    /// The keyword as text, for messages.
    pub fn keyword_text(&self) -> String {
        decode(self.keyword)
    }
}

/// Calls `each` for every statement of `bytes`, in order.
pub(super) fn for_each_statement(bytes: &[u8], mut each: impl FnMut(&Statement)) {
    let mut rest = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let mut next_line = 1;
    while !rest.is_empty() {
        let line = next_line;
        let first = take_line(&mut rest);
        next_line += 1;
        let mut logical: Cow<[u8]> = Cow::Borrowed(first);
        // A comment does not go on, so that one ending in a Windows path swallows nothing.
        if !is_comment(first) {
            let mut last = first;
            while let Some(head) = last.trim_ascii_end().strip_suffix(b"\\") {
                let joined = logical.to_mut();
                joined.truncate(joined.len() - (last.len() - head.len()));
                joined.push(b' ');
                if rest.is_empty() {
                    break;
                }
                last = take_line(&mut rest);
                next_line += 1;
                joined.extend_from_slice(last);
            }
        }
        let text = logical.trim_ascii();
        if let Some(keyword) = words(text).next()
            && keyword[0] != b'#'
        {
            each(&Statement {
                line,
                keyword,
                text: text.trim_ascii_start()[keyword.len()..].trim_ascii(),
            });
        }
    }
}

/// Cuts the first physical line off `rest`; LF, CR LF and CR end a line.
fn take_line<'a>(rest: &mut &'a [u8]) -> &'a [u8] {
    match rest.iter().position(|&b| b == b'\n' || b == b'\r') {
        None => std::mem::take(rest),
        Some(end) => {
            let line = &rest[..end];
            let skip = if rest[end..].starts_with(b"\r\n") {
                2
            } else {
                1
            };
            *rest = &rest[end + skip..];
            line
        }
    }
}

fn is_comment(line: &[u8]) -> bool {
    line.trim_ascii_start().starts_with(b"#")
}

/// Words separated by ASCII white space (Latin-1's own, such as NBSP, may stand in a name).
fn words(text: &[u8]) -> impl Iterator<Item = &[u8]> {
    text.split(u8::is_ascii_whitespace)
        .filter(|w| !w.is_empty())
}

/// UTF-8 where it is, else Latin-1, in which every byte is the character of its number.
pub(super) fn decode(bytes: &[u8]) -> String {
    match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => bytes.iter().map(|&b| char::from(b)).collect(),
    }
}

/// A finite number.
pub(super) fn number(word: &[u8]) -> Result<f64, Reason> {
    match std::str::from_utf8(word).ok().and_then(|w| w.parse().ok()) {
        Some(value) if f64::is_finite(value) => Ok(value),
        Some(_) => Err(Reason::NotFinite(decode(word))),
        // What printf of some C libraries makes of NaN and infinity.
        None if is_printed_non_number(word) => Err(Reason::NotFinite(decode(word))),
        None => Err(Reason::NotANumber(decode(word))),
    }
}

fn is_printed_non_number(word: &[u8]) -> bool {
    let word = word.to_ascii_lowercase();
    let word = word.trim_ascii();
    let unsigned = word.strip_prefix(b"-").unwrap_or(word);
    [b"nan(".as_slice(), b"1.#ind", b"1.#qnan", b"1.#inf"]
        .iter()
        .any(|p| unsigned.starts_with(p))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(bytes: &[u8]) -> Vec<(usize, String, Vec<String>)> {
        let mut out = Vec::new();
        for_each_statement(bytes, |s| {
            out.push((s.line, s.keyword_text(), s.values().map(decode).collect()));
        });
        out
    }

    fn owned(line: usize, keyword: &str, values: &[&str]) -> (usize, String, Vec<String>) {
        (
            line,
            keyword.into(),
            values.iter().map(|&v| v.into()).collect(),
        )
    }

    #[test]
    fn line_endings_and_byte_order_mark() {
        let expected = vec![owned(1, "v", &["1", "2"]), owned(3, "f", &["1"])];
        for text in [
            "\u{feff}v 1 2\n\nf 1\n",
            "v 1 2\r\n\r\nf 1\r\n",
            "v\t1  2\r\rf 1",
        ] {
            assert_eq!(all(text.as_bytes()), expected, "{text:?}");
        }
    }

    #[test]
    fn continuations_keep_the_first_line_number() {
        let text = b"v 1 \\\n 2 \\\r\n 3\nf 1\n# c:\\\nv 4\\";
        let expected = vec![
            owned(1, "v", &["1", "2", "3"]),
            owned(4, "f", &["1"]),
            owned(6, "v", &["4"]),
        ];
        assert_eq!(all(text), expected);
        assert_eq!(all(b"# c:\\\nv 4")[0].0, 2, "a comment swallows nothing");
    }

    #[test]
    fn comments_end_values_but_not_names() {
        let text = b"Kd 1 2 3 # red\nusemtl Material #25\n#f 1 2 3";
        let mut names = Vec::new();
        for_each_statement(text, |s| names.push(s.name()));
        assert_eq!(names[1], "Material #25");
        assert_eq!(all(text)[0].2, ["1", "2", "3"]);
        assert_eq!(names.len(), 2);
    }

    #[test]
    fn numbers() {
        assert_eq!(number(b"-.5e1"), Ok(-5.0));
        for word in [
            "nan",
            "NaN",
            "inf",
            "-inf",
            "1e999",
            "-nan(ind)",
            "1.#INF",
            "-1.#IND",
        ] {
            assert_eq!(
                number(word.as_bytes()),
                Err(Reason::NotFinite(word.into())),
                "{word}"
            );
        }
        for word in ["1,5", "1.0f", "--1", "0x1", "\u{fffd}"] {
            assert_eq!(
                number(word.as_bytes()),
                Err(Reason::NotANumber(word.into())),
                "{word}"
            );
        }
    }
}
