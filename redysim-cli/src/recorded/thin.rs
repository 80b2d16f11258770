//! Fewer rows than a long run has, for those who look at it.

/// At most `most` of `count` rows (two at least), evenly spread, with the first and the last.
pub fn evenly(count: usize, most: usize) -> Vec<usize> {
    let kept = count.min(most.max(2));
    if kept < 2 {
        return (0..count).collect();
    }
    // In u128, so that no number of rows overflows.
    let row = |k: usize| (k as u128 * (count - 1) as u128 / (kept - 1) as u128) as usize;
    (0..kept).map(row).collect()
}

/// About `most` of the curves' rows, in order: the first, the last, and of every stretch those where a curve has its
/// least and its largest value, and the first instant without a value, so that no peak and no gap is lost.
pub fn with_peaks(curves: &[&[f64]], count: usize, most: usize) -> Vec<usize> {
    if count <= most || curves.is_empty() {
        return evenly(count, most);
    }
    let stretches = (most / (2 * curves.len())).max(50);
    let length = count.div_ceil(stretches);
    let mut rows = vec![0, count - 1];
    for start in (0..count).step_by(length) {
        let stretch = || start..(start + length).min(count);
        for values in curves {
            let order = |a: &usize, b: &usize| values[*a].total_cmp(&values[*b]);
            let finite = |row: &usize| values[*row].is_finite();
            rows.extend(stretch().filter(finite).min_by(order));
            rows.extend(stretch().filter(finite).max_by(order));
            rows.extend(stretch().find(|row| !finite(row)));
        }
    }
    rows.sort_unstable();
    rows.dedup();
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_run_is_thinned_without_losing_its_ends() {
        for (count, most) in [(0, 5), (1, 5), (2, 5), (5, 5), (6, 5), (100_000, 1000)] {
            let rows = evenly(count, most);
            assert_eq!(rows.len(), count.min(most), "{count} rows");
            assert!(rows.windows(2).all(|pair| pair[0] < pair[1]), "{count} rows: {rows:?}");
            assert_eq!(rows.last().map_or(0, |last| last + 1), count);
        }
    }

    #[test]
    fn a_peak_of_a_single_row_is_still_seen() {
        let mut values = vec![0.0; 100_000];
        values[77_777] = 1.0;
        values[33_333] = -1.0;
        let rows = with_peaks(&[&values], values.len(), 2000);
        assert!(rows.contains(&77_777) && rows.contains(&33_333));
        assert!(rows.contains(&0) && rows.contains(&99_999));
        assert!(rows.len() <= 2002, "{}", rows.len());
        values[77_778] = f64::NAN;
        let rows = with_peaks(&[&values], values.len(), 2000);
        assert!(rows.contains(&77_777) && rows.contains(&77_778), "a peak beside a gap, and the gap");
    }
}
