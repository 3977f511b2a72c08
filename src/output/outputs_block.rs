//! The files beside a solution, and what each was made with: so that whoever comes back knows which are to be made anew.

use serde::de::{MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::value::RawValue;
use std::collections::BTreeMap;
use std::fmt;

/// Options by the names of their flags, by the name of the file that they made.
pub type OutputsBlock = BTreeMap<String, BTreeMap<String, String>>;

/// The key of the block in `stats.json`.
const KEY: &str = "outputs";

/// The block of a `stats.json`; empty where it has none.
///
/// # Errors
/// Where it is not JSON, or the block something else.
pub fn read_outputs(stats: &[u8]) -> Result<OutputsBlock, serde_json::Error> {
    let entries: Entries = serde_json::from_slice(stats)?;
    match entries.0.iter().find(|(key, _)| key == KEY) {
        None => Ok(OutputsBlock::new()),
        Some((_, value)) => serde_json::from_str(value.get()),
    }
}

/// A `stats.json` with another block, and all else as it stood, to the byte.
///
/// # Errors
/// Where it is not JSON.
pub fn replace_outputs(stats: &[u8], outputs: &OutputsBlock) -> Result<String, serde_json::Error> {
    let mut entries: Entries = serde_json::from_slice(stats)?;
    // As deep as it will stand.
    let text = serde_json::to_string_pretty(outputs)?.replace('\n', "\n  ");
    let block = RawValue::from_string(text)?;
    match entries.0.iter_mut().find(|(key, _)| key == KEY) {
        Some((_, value)) => *value = block,
        None => entries.0.push((KEY.to_owned(), block)),
    }
    Ok(serde_json::to_string_pretty(&entries)? + "\n")
}

/// A JSON object with its order and the text of its values.
struct Entries(Vec<(String, Box<RawValue>)>);

impl<'de> Deserialize<'de> for Entries {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct InOrder;
        impl<'de> Visitor<'de> for InOrder {
            type Value = Entries;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an object")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Entries, A::Error> {
                let mut entries = Vec::new();
                while let Some(entry) = map.next_entry()? {
                    entries.push(entry);
                }
                Ok(Entries(entries))
            }
        }
        deserializer.deserialize_map(InOrder)
    }
}

impl Serialize for Entries {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(key, value)| (key, value)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outputs(pairs: &[(&str, &[(&str, &str)])]) -> OutputsBlock {
        let own = |(k, v): &(&str, &str)| ((*k).to_owned(), (*v).to_owned());
        pairs
            .iter()
            .map(|(file, options)| ((*file).to_owned(), options.iter().map(own).collect()))
            .collect()
    }

    #[derive(Serialize)]
    struct Stats {
        zeal: [f64; 3],
        outputs: OutputsBlock,
        power: BTreeMap<&'static str, f64>,
    }

    #[test]
    fn a_replaced_block_leaves_the_rest_to_the_byte() {
        let text = |outputs: OutputsBlock| {
            let stats = Stats {
                zeal: [1e-7, 0.1 + 0.2, f64::MAX],
                outputs,
                power: [("emitted", 3.0)].into(),
            };
            serde_json::to_string_pretty(&stats).unwrap() + "\n"
        };
        let before = outputs(&[("view.png", &[("up", "auto")])]);
        let after = outputs(&[("solution.vtu", &[]), ("view.png", &[("up", "z")])]);
        let old = text(before.clone());
        assert_eq!(read_outputs(old.as_bytes()).unwrap(), before);
        let new = replace_outputs(old.as_bytes(), &after).unwrap();
        assert_eq!(new, text(after));
    }

    #[test]
    fn a_file_without_the_block_gets_one() {
        let old = b"{\"format\": 1}";
        assert!(read_outputs(old).unwrap().is_empty());
        let block = outputs(&[("view.png", &[("up", "x")])]);
        let new = replace_outputs(old, &block).unwrap();
        assert_eq!(read_outputs(new.as_bytes()).unwrap(), block);
        assert!(new.contains("\"format\": 1"), "{new}");
        assert!(read_outputs(b"[1]").is_err());
    }
}
