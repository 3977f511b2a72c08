//! A `map_Kd` or `map_Ke` statement: the image and how it is laid on the surface.

use super::error::Reason;
use super::statement::{Statement, decode, number};
use glam::DVec2;

/// Where a texture comes from and how texture coordinates address it:
/// `image = coordinate * scale + offset`, repeating unless clamped.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct TextureMap {
    /// File name as written.
    pub file: String,
    /// Line of the statement.
    pub line: usize,
    /// `-s`.
    pub scale: DVec2,
    /// `-o`.
    pub offset: DVec2,
    /// `-clamp on`: beyond [0, 1] the border goes on.
    pub clamp: bool,
}

/// How many words may follow an option.
enum Following {
    /// Exactly so many.
    Words(usize),
    /// One to so many numbers.
    Numbers(usize),
}

/// Options of the MTL format; of these `-o`, `-s` and `-clamp` are heeded.
fn option_arguments(option: &[u8]) -> Option<Following> {
    Some(match option {
        b"-blendu" | b"-blendv" | b"-cc" | b"-clamp" | b"-imfchan" | b"-type" | b"-colorspace" => {
            Following::Words(1)
        }
        b"-bm" | b"-boost" | b"-texres" => Following::Numbers(1),
        b"-mm" => Following::Numbers(2),
        b"-o" | b"-s" | b"-t" => Following::Numbers(3),
        _ => return None,
    })
}

impl TextureMap {
    /// The map of a statement, and the options that are left out of account.
    pub fn parse(statement: &Statement) -> Result<(Self, Vec<String>), Reason> {
        let mut map = Self {
            file: String::new(),
            line: statement.line,
            scale: DVec2::ONE,
            offset: DVec2::ZERO,
            clamp: false,
        };
        let mut ignored = Vec::new();
        let text = statement.name_bytes();
        let mut rest = text;
        while let Some(option) = first_word(rest).filter(|w| w.starts_with(b"-")) {
            let Some(arguments) = option_arguments(option) else {
                // Not an option, so a file whose name begins with a dash.
                break;
            };
            rest = after_word(rest);
            match arguments {
                Following::Words(count) => {
                    for _ in 0..count {
                        if option == b"-clamp" {
                            map.clamp = first_word(rest) == Some(b"on");
                        }
                        rest = after_word(rest);
                    }
                }
                Following::Numbers(most) => {
                    let mut values = [None; 3];
                    for slot in values.iter_mut().take(most) {
                        // The file name comes last, even if it looks like a number.
                        let word = first_word(rest).filter(|_| !after_word(rest).is_empty());
                        let Some(word) = word else { break };
                        match number(word) {
                            Ok(value) => *slot = Some(value),
                            Err(reason @ Reason::NotFinite(_)) => return Err(reason),
                            Err(_) => break,
                        }
                        rest = after_word(rest);
                    }
                    let vector = |default: f64| {
                        DVec2::new(values[0].unwrap_or(default), values[1].unwrap_or(default))
                    };
                    match option {
                        b"-o" => map.offset = vector(0.0),
                        b"-s" => map.scale = vector(1.0),
                        _ => {}
                    }
                }
            }
            if !matches!(
                option,
                b"-o" | b"-s" | b"-clamp" | b"-blendu" | b"-blendv" | b"-texres" | b"-type"
            ) {
                ignored.push(decode(option));
            }
        }
        map.file = decode(rest);
        if map.file.is_empty() {
            return Err(Reason::MissingName(statement.keyword_text()));
        }
        Ok((map, ignored))
    }
}

fn first_word(text: &[u8]) -> Option<&[u8]> {
    text.split(u8::is_ascii_whitespace)
        .next()
        .filter(|w| !w.is_empty())
}

fn after_word(text: &[u8]) -> &[u8] {
    let end = first_word(text).map_or(0, <[u8]>::len);
    text[end..].trim_ascii_start()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::statement::for_each_statement;

    fn parse(text: &str) -> Result<(TextureMap, Vec<String>), Reason> {
        let mut out = None;
        for_each_statement(text.as_bytes(), |s| out = Some(TextureMap::parse(s)));
        out.unwrap()
    }

    #[test]
    fn options_are_told_from_the_file_name() {
        let (map, ignored) =
            parse("map_Kd -s 2 3 -o 0.5 -clamp on -mm 0 1.5 -blendu off my wood 2.png").unwrap();
        assert_eq!(map.file, "my wood 2.png");
        assert_eq!(map.scale, DVec2::new(2.0, 3.0));
        assert_eq!(map.offset, DVec2::new(0.5, 0.0));
        assert!(map.clamp);
        assert_eq!(ignored, ["-mm"]);
        assert_eq!(parse("map_Kd -s 1 1 1 7").unwrap().0.file, "7");
        assert_eq!(parse("map_Kd -o 1 -odd.png").unwrap().0.file, "-odd.png");
    }

    #[test]
    fn a_statement_without_a_file_is_refused() {
        for text in ["map_Kd", "map_Kd -clamp on", "map_Ke -bm"] {
            assert!(matches!(parse(text), Err(Reason::MissingName(_))), "{text}");
        }
        assert_eq!(
            parse("map_Kd -o nan 0 a.png"),
            Err(Reason::NotFinite("nan".into()))
        );
    }
}
