//! The power ledger: its arithmetic, and how much power goes missing at default settings.

use crate::case::Case;

fn check_ledger(name: &str) {
    let power = Case::builtin(name).solved.power;
    let rest = power.emitted - power.absorbed - power.escaped - power.unshot;
    eprintln!(
        "{name:<28} emitted {:.4} W, imbalance {:>8.4} % of 1 %",
        power.emitted,
        100.0 * power.imbalance
    );
    assert!(
        power.emitted > 0.0 && power.absorbed > 0.0,
        "{name}: {power:?}"
    );
    assert!(
        (rest / power.emitted - power.imbalance).abs() <= 1e-9,
        "{name}: {power:?}"
    );
    assert!(power.imbalance.abs() <= 0.01, "{name}: {power:?}");
}

#[test]
fn cornell_balances() {
    check_ledger("cornell");
}

#[test]
fn two_rooms_balance() {
    check_ledger("two-rooms");
}

#[test]
fn corridor_balances() {
    check_ledger("corridor");
}

#[test]
fn d_balances() {
    check_ledger("d");
}
