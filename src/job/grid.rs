//! All combinations of the choices of a grid.

use super::setting::Setting;

/// Most combinations of a grid, far more than anyone waits for.
pub const MOST_COMBINATIONS: usize = 100_000;

/// Every way to take one of each list, the last list changing fastest; one empty way where there is no list. `None` if
/// there are too many.
pub fn combinations(choices: &[Vec<Setting>]) -> Option<Vec<Vec<Setting>>> {
    let mut ways: Vec<Vec<Setting>> = vec![Vec::new()];
    for list in choices {
        if ways.len().saturating_mul(list.len()) > MOST_COMBINATIONS {
            return None;
        }
        ways = ways
            .iter()
            .flat_map(|way| {
                list.iter().map(move |choice| {
                    let mut way = way.clone();
                    way.push(choice.clone());
                    way
                })
            })
            .collect();
    }
    Some(ways)
}

#[cfg(test)]
mod tests {
    use super::super::setting::SettingValue;
    use super::*;

    fn list(key: &str, values: &[&str]) -> Vec<Setting> {
        let setting = |v: &&str| Setting {
            key: key.to_owned(),
            value: SettingValue::Text((*v).to_owned()),
            line: 1,
        };
        values.iter().map(setting).collect()
    }

    #[test]
    fn each_combination_comes_once_in_order() {
        let ways = combinations(&[list("a", &["1", "2"]), list("b", &["x", "y", "z"])]).unwrap();
        let text: Vec<String> = ways
            .iter()
            .map(|w| w.iter().filter_map(Setting::argument).collect())
            .collect();
        let want = [
            "--a=1--b=x",
            "--a=1--b=y",
            "--a=1--b=z",
            "--a=2--b=x",
            "--a=2--b=y",
            "--a=2--b=z",
        ];
        assert_eq!(text, want);
        assert_eq!(combinations(&[]).unwrap(), [Vec::new()]);
    }

    #[test]
    fn too_many_are_refused_before_they_are_made() {
        let values: Vec<String> = (0..1000).map(|i| i.to_string()).collect();
        let values: Vec<&str> = values.iter().map(String::as_str).collect();
        let lists = vec![list("a", &values); 40];
        assert_eq!(combinations(&lists), None);
    }
}
