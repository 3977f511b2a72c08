//! The Pareto front of points that are better the smaller both their numbers are.

/// For each point, whether none of the others is at least as small in both numbers and smaller in one.
/// Of points that are equal in both all stand on the front, or none. Points with a number that is not
/// finite never do. Time grows as n log n.
pub fn pareto_front(points: &[[f64; 2]]) -> Vec<bool> {
    let mut order: Vec<usize> = (0..points.len())
        .filter(|&i| points[i].iter().all(|x| x.is_finite()))
        .collect();
    // Adding zero makes the two zeros one, which the total order tells apart.
    let compare = |i: usize, j: usize| {
        let [a, b] = [i, j].map(|k| points[k].map(|x| x + 0.0));
        a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1]))
    };
    order.sort_by(|&i, &j| compare(i, j));
    let mut front = vec![false; points.len()];
    let mut last: Option<[f64; 2]> = None;
    for i in order {
        let point = points[i];
        // Sorted by the first number, a point is beaten by an earlier one unless its second is smaller.
        if last.is_none_or(|l| point[1] < l[1] || point == l) {
            front[i] = true;
            last = Some(point);
        }
    }
    front
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn by_definition(points: &[[f64; 2]]) -> Vec<bool> {
        let finite = |p: &[f64; 2]| p[0].is_finite() && p[1].is_finite();
        let beats = |a: &[f64; 2], b: &[f64; 2]| {
            a[0] <= b[0] && a[1] <= b[1] && (a[0] < b[0] || a[1] < b[1])
        };
        points
            .iter()
            .map(|p| finite(p) && !points.iter().any(|q| finite(q) && beats(q, p)))
            .collect()
    }

    #[test]
    fn three_of_five() {
        let points = [[1.0, 5.0], [2.0, 2.0], [3.0, 2.0], [4.0, 1.0], [4.0, 3.0]];
        assert_eq!(pareto_front(&points), [true, true, false, true, false]);
    }

    #[test]
    fn nothing_and_not_a_number() {
        assert!(pareto_front(&[]).is_empty());
        let points = [[f64::NAN, 0.0], [1.0, f64::INFINITY], [2.0, 2.0]];
        assert_eq!(pareto_front(&points), [false, false, true]);
    }

    proptest! {
        // Few values, so that ties of every kind are common.
        #[test]
        fn agrees_with_the_definition(
            points in proptest::collection::vec((0u8..6, 0u8..6), 0..40)
        ) {
            let value = |x: u8| match x {
                0 => -0.0,
                5 => f64::NAN,
                x => f64::from(x) - 1.0,
            };
            let points: Vec<[f64; 2]> = points.iter().map(|&(x, y)| [value(x), value(y)]).collect();
            prop_assert_eq!(pareto_front(&points), by_definition(&points));
        }

        #[test]
        fn agrees_with_the_definition_on_any_numbers(
            points in proptest::collection::vec(proptest::array::uniform2(0.0f64..1.0), 1..60)
        ) {
            prop_assert_eq!(pareto_front(&points), by_definition(&points));
        }
    }
}
