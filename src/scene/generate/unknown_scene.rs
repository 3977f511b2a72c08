//! The error for a scene that is not in the catalogue.

/// There is no built-in scene of that name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no built-in scene is called `{name}`{}; `certilux generate --list` names all", hint(.near))]
pub struct UnknownScene {
    /// What was asked for.
    pub name: String,
    /// Names of scenes that exist and are like it, nearest first.
    pub near: Vec<String>,
}

/// How many names are offered.
const OFFERED: usize = 3;

/// A name is like another if no more than every so many letters differ (one letter always may), or if it begins with
/// it, as a wrong reflectance of `furnace-RHO` does.
const LETTERS_AN_EDIT: usize = 3;

fn hint(near: &[String]) -> String {
    match near {
        [] => String::new(),
        _ => format!("; did you mean {}?", near.join(", ")),
    }
}

impl UnknownScene {
    /// The error for `name` among the `known` names.
    pub(super) fn new<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> Self {
        let mut near: Vec<(usize, &str)> = known
            .map(|k| (strsim::levenshtein(name, k), k))
            .filter(|&(edits, k)| {
                let letters = name.chars().count().max(k.chars().count());
                let begins = k.starts_with(name) || (k.len() > 1 && name.starts_with(k));
                !name.is_empty() && (begins || edits <= (letters / LETTERS_AN_EDIT).max(1))
            })
            .collect();
        near.sort();
        near.truncate(OFFERED);
        Self {
            name: name.to_owned(),
            near: near.into_iter().map(|(_, k)| k.to_owned()).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_names_that_are_alike_are_offered() {
        let near = |name: &str| {
            let known = ["a", "b", "cornell", "two-rooms", "cie171-5.4"];
            UnknownScene::new(name, known.into_iter())
        };
        assert_eq!(near("cornel").near, ["cornell"]);
        assert_eq!(near("tworoom").near, ["two-rooms"]);
        assert_eq!(near("cie171").near, ["cie171-5.4"]);
        for name in ["nope", "kitchen"] {
            let text = near(name).to_string();
            assert!(!text.contains("did you mean"), "{text}");
        }
        assert!(near("cornel").to_string().contains("did you mean cornell?"));
    }
}
