//! The error for a scene that is not in the catalogue.

/// There is no built-in scene of that name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no built-in scene is called `{name}`; did you mean {}?", near.join(", "))]
pub struct UnknownScene {
    /// What was asked for.
    pub name: String,
    /// Names of scenes that exist, nearest first; never empty.
    pub near: Vec<String>,
}

/// How many names are offered.
const OFFERED: usize = 3;

impl UnknownScene {
    /// The error for `name` among the `known` names.
    pub(super) fn new<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> Self {
        let mut near: Vec<(usize, &str)> = known.map(|k| (edits(name, k), k)).collect();
        near.sort();
        near.truncate(OFFERED);
        Self {
            name: name.to_owned(),
            near: near.into_iter().map(|(_, k)| k.to_owned()).collect(),
        }
    }
}

/// Number of insertions, deletions and replacements between two words (Levenshtein 1966).
fn edits(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, &y) in b.iter().enumerate() {
            let replaced = diagonal + usize::from(x != y);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edits_counts_insertions_deletions_and_replacements() {
        assert_eq!(edits("", "abc"), 3);
        assert_eq!(edits("cornel", "cornell"), 1);
        assert_eq!(edits("kitten", "sitting"), 3);
        assert_eq!(edits("same", "same"), 0);
    }
}
