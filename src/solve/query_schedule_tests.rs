//! When queries are asked, and when no more.

use super::config::Technique;
use super::queries::{Evidence, Occasion, Queries};
use super::query_schedule::{QuerySchedule, SIZES, size};

fn after(technique: Technique, evidence: &[Evidence]) -> QuerySchedule {
    let mut schedule = QuerySchedule::new(technique);
    for &e in evidence {
        schedule.observe(e);
    }
    schedule
}

#[test]
fn neighbours_rule_out_what_is_not_likely() {
    use Evidence::{Blocked, Clear, Dark, Mixed};
    let asked = |technique, evidence: &[Evidence]| {
        after(technique, evidence).before_split(100.0, f32::INFINITY)
    };
    assert_eq!(asked(Technique::Occlusion, &[]), Queries::None);
    assert_eq!(asked(Technique::Occlusion, &[Blocked]), Queries::Occlusion);
    assert_eq!(asked(Technique::Occlusion, &[Clear]), Queries::Visibility);
    assert_eq!(asked(Technique::Occlusion, &[Clear, Mixed]), Queries::None);
    assert_eq!(
        asked(Technique::Occlusion, &[Mixed, Clear, Dark]),
        Queries::Visibility
    );
    assert_eq!(asked(Technique::Visibility, &[Blocked]), Queries::None);
    assert_eq!(asked(Technique::Blockers, &[Mixed]), Queries::Shorten);
}

#[test]
fn small_pairs_and_pairs_just_below_one_looked_at_are_passed_over() {
    let asked = |expected, asked_at| {
        after(Technique::Occlusion, &[Evidence::Clear]).before_split(expected, asked_at)
    };
    assert_eq!(asked(1.9, f32::INFINITY), Queries::None);
    assert_eq!(asked(100.0, 199.0), Queries::None);
    assert_eq!(asked(100.0, 200.0), Queries::Visibility);
}

#[test]
fn where_nothing_pays_most_pairs_are_passed_over_until_something_does() {
    let mut schedule = after(Technique::Occlusion, &[Evidence::Blocked]);
    let split = Occasion::Split(100.0);
    let looked_at = |schedule: &mut QuerySchedule, success: bool| -> u32 {
        let look = |_| {
            let looks = schedule.may_ask();
            if looks && schedule.before_split(100.0, f32::INFINITY) != Queries::None {
                schedule.learn_occlusion(split, success, 100);
            }
            u32::from(looks)
        };
        (0..1_600).map(look).sum()
    };
    looked_at(&mut schedule, false);
    let barren = looked_at(&mut schedule, false);
    assert!((100..130).contains(&barren), "{barren}");
    for _ in 0..64 {
        schedule.learn_occlusion(split, true, 1);
    }
    assert!(looked_at(&mut schedule, true) > 1_580);
}

/// Whether tasks that start with what `learned` did ask after such a neighbour.
fn asks_on(learned: &QuerySchedule, neighbour: Evidence) -> bool {
    let schedules = std::iter::once(learned);
    let mut others = QuerySchedule::after(Technique::Occlusion, schedules);
    others.observe(neighbour);
    let look = others.may_ask();
    // Asked again and again, since a single exchange is asked about only now and then.
    let asked = (0..100).any(|_| others.before_exchange(8.0) != Queries::None);
    assert_eq!(look, asked);
    look
}

#[test]
fn where_proofs_of_occlusion_gained_nothing_in_the_first_tasks_the_others_ask_for_none() {
    use Evidence::{Blocked, Clear};
    // Each costs one packet.
    let spent = |queries: u32, success: bool| {
        let mut schedule = after(Technique::Occlusion, &[Blocked]);
        for _ in 0..queries {
            schedule.learn_occlusion(Occasion::Split(10.0), success, 12);
        }
        schedule
    };
    assert!(asks_on(&spent(240, false), Blocked), "too few to tell");
    assert!(!asks_on(&spent(260, false), Blocked));
    // Fewer than are worth their price, but too few to tell as long as there is some success.
    let mut poor = spent(900, false);
    poor.learn_occlusion(Occasion::Exchange(400.0), true, 12);
    assert!(asks_on(&poor, Blocked));
    for _ in 0..200 {
        poor.learn_occlusion(Occasion::Split(10.0), false, 12);
    }
    assert!(!asks_on(&poor, Blocked));
    assert!(
        asks_on(&spent(260, false), Clear),
        "of walks nothing is known"
    );
    // Of ten that a proof hides more was saved than the query cost, but where little came of what was expected.
    let mut paid = spent(1_100, true);
    assert!(asks_on(&paid, Blocked));
    paid.book_below(10.0, 5.0);
    assert!(asks_on(&paid, Blocked));
    for _ in 0..4 {
        paid.book_below(10.0, 0.0);
    }
    assert!(!asks_on(&paid, Blocked));
}

#[test]
fn where_walks_gained_nothing_in_the_first_tasks_the_others_make_none() {
    use Evidence::{Blocked, Clear};
    let mut walked = after(Technique::Occlusion, &[Clear]);
    // Each costs one packet.
    for _ in 0..1_100 {
        walked.learn_walk(Queries::Visibility, Occasion::Split(10.0), true, 3);
    }
    assert!(!asks_on(&walked, Clear), "no exchange was saved");
    assert!(asks_on(&walked, Blocked));
    let gave_up = |s: &QuerySchedule| {
        QuerySchedule::after(Technique::Visibility, std::iter::once(s)).gave_up()
    };
    assert!(gave_up(&walked));
    walked.book_visible(1_300.0);
    assert!(!asks_on(&walked, Clear));
    walked.book_visible(200.0);
    assert!(asks_on(&walked, Clear));
    assert!(!gave_up(&walked));
}

#[test]
fn a_single_exchange_is_asked_about_once_experience_says_that_it_pays() {
    let mut schedule = after(Technique::Occlusion, &[Evidence::Blocked]);
    let exchange = Occasion::Exchange(1.2);
    assert_eq!(schedule.before_exchange(1.2), Queries::None);
    for _ in 0..64 {
        schedule.learn_occlusion(exchange, true, 3);
    }
    assert_eq!(schedule.before_exchange(1.2), Queries::Occlusion);
    // Not for what happened after other neighbours.
    schedule.observe(Evidence::Blocked);
    assert_eq!(schedule.before_exchange(1.2), Queries::None);
}

#[test]
fn sizes_are_powers_of_four() {
    let sizes = [0.0, 1.2, 3.9, 4.1, 17.0, 1.0e30].map(size);
    assert_eq!(sizes, [0, 0, 0, 1, 2, SIZES - 1]);
}
