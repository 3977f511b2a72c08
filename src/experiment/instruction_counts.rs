//! Instructions of a solve's passes: they catch the slow-downs of a few percent that a clock on a shared machine
//! cannot.

use super::baseline_key::BaselineKey;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Instructions that callgrind counts in the passes of a small solve, by technique.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct InstructionCounts {
    /// The compiler that built the program.
    pub compiler: String,
    /// What was solved: the command's arguments without the technique.
    pub solve: String,
    /// Instructions by technique.
    pub by_technique: BTreeMap<String, u64>,
}

/// Share by which instructions may exceed the baseline's: threads' scheduling and addresses move them by a hundredth
/// of it.
const TOLERANCE: f64 = 0.03;

/// What got dearer; `None` if the two cannot be compared, since compiler, key or solve differ.
pub fn dearer(
    was: (&BaselineKey, &InstructionCounts),
    is: (&BaselineKey, &InstructionCounts),
) -> Option<Vec<String>> {
    let ((old_key, old), (new_key, new)) = (was, is);
    if old_key != new_key || old.compiler != new.compiler || old.solve != new.solve {
        return None;
    }
    let mut found = Vec::new();
    for (technique, &was) in &old.by_technique {
        let Some(&is) = new.by_technique.get(technique) else {
            found.push(format!("instructions of {technique}: not counted"));
            continue;
        };
        let change = is as f64 / was.max(1) as f64 - 1.0;
        if change > TOLERANCE {
            found.push(format!(
                "instructions of {technique}: {was} in the baseline, {is} now ({:+.1} %)",
                100.0 * change
            ));
        }
    }
    Some(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn counts(normal: u64) -> InstructionCounts {
        InstructionCounts {
            compiler: "rustc 1.95.0".to_owned(),
            solve: "solve builtin:d".to_owned(),
            by_technique: [("normal".to_owned(), normal)].into(),
        }
    }

    #[test]
    fn five_percent_is_found_and_another_compiler_is_not_compared() {
        let key = BaselineKey::here("4.3.3".to_owned(), "avx2");
        let compare =
            |old: &InstructionCounts, new: &InstructionCounts| dearer((&key, old), (&key, new));
        let old = counts(1_000_000);
        assert_eq!(compare(&old, &counts(1_010_000)), Some(vec![]));
        assert_eq!(compare(&old, &counts(900_000)), Some(vec![]));
        let found = compare(&old, &counts(1_050_000)).unwrap();
        assert!(found[0].contains("+5.0 %"), "{found:?}");
        let mut other = counts(1_050_000);
        other.compiler = "rustc 1.96.0".to_owned();
        assert_eq!(compare(&old, &other), None);
        other = counts(1);
        other.by_technique.clear();
        assert_eq!(compare(&old, &other).unwrap().len(), 1);
    }
}
