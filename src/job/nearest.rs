//! The name that a misspelt one was probably meant to be.

/// Likeness from which a name is worth suggesting: the measure and the bound by which the command line's own
/// parser suggests flags (Jaro, 0.7).
const ALIKE: f64 = 0.7;

/// The one of `names` that is most like `word`, if any is like it at all; the first of equals.
pub fn nearest<'a>(word: &str, names: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    // What the eye takes for the same is the same.
    let plain = |text: &str| text.to_lowercase().replace('_', "-");
    let word = plain(word);
    let mut best: Option<(f64, &str)> = None;
    for name in names {
        let likeness = strsim::jaro(&word, &plain(name));
        if likeness > best.map_or(ALIKE, |(l, _)| l) {
            best = Some((likeness, name));
        }
    }
    best.map(|(_, name)| name)
}

/// ` (did you mean ...?)`, or nothing.
pub fn suggestion<'a>(word: &str, names: impl IntoIterator<Item = &'a str>) -> String {
    nearest(word, names).map_or_else(String::new, |name| format!("; did you mean `{name}`?"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn misspelt_names_are_found_and_others_are_not() {
        let names = ["epsilon", "min-area", "technique", "passes"];
        for (word, want) in [
            ("epsilom", Some("epsilon")),
            ("EPSILON", Some("epsilon")),
            ("min_area", Some("min-area")),
            ("tecnique", Some("technique")),
            ("passess", Some("passes")),
            ("zzz", None),
            ("", None),
        ] {
            assert_eq!(nearest(word, names), want, "{word}");
        }
        assert_eq!(nearest("x", []), None);
    }
}
