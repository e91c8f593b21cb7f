//! "Did you mean": the known name closest to a misspelled one.

/// The candidate closest to `name`, ignoring ASCII case, if it is close enough to be meant: at most
/// a third of the letters and at most three differ, and never all. Of equally close ones the first. Names of more than
/// 64 letters get no suggestion, which keeps the work small.
pub fn closest<'c>(name: &str, candidates: impl IntoIterator<Item = &'c str>) -> Option<&'c str> {
    let third = name.chars().count().div_ceil(3);
    closest_within(name, third.min(3), candidates)
}

/// The candidate closest to `name`, ignoring ASCII case, if at most `limit` letters differ, and not
/// all. Of equally close ones the first. Names of more than 64 letters get no suggestion.
pub fn closest_within<'c>(
    name: &str,
    limit: usize,
    candidates: impl IntoIterator<Item = &'c str>,
) -> Option<&'c str> {
    let wanted: Vec<char> = name.to_ascii_lowercase().chars().collect();
    if wanted.len() > 64 {
        return None;
    }
    let limit = limit.min(wanted.len().saturating_sub(1));
    let measured = candidates.into_iter().filter_map(|candidate| {
        let other: Vec<char> = candidate.to_ascii_lowercase().chars().collect();
        let close = other.len().abs_diff(wanted.len()) <= limit;
        close.then(|| (distance(&wanted, &other), candidate))
    });
    let best = measured.min_by_key(|(distance, _)| *distance);
    best.filter(|(distance, _)| *distance <= limit)
        .map(|(_, name)| name)
}

/// Letters to insert, remove, replace, or exchange with their neighbour.
fn distance(a: &[char], b: &[char]) -> usize {
    let mut before_last = vec![0; b.len() + 1];
    let mut last: Vec<usize> = (0..=b.len()).collect();
    for i in 1..=a.len() {
        let mut row = vec![i; b.len() + 1];
        for j in 1..=b.len() {
            let replaced = last[j - 1] + usize::from(a[i - 1] != b[j - 1]);
            row[j] = replaced.min(last[j] + 1).min(row[j - 1] + 1);
            let exchanged = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
            if exchanged {
                row[j] = row[j].min(before_last[j - 2] + 1);
            }
        }
        before_last = std::mem::replace(&mut last, row);
    }
    last[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_closest_name_is_found_ignoring_case() {
        let names = ["Start", "Stop", "Lamp", "tonp1"];
        for (name, expected) in [
            ("strat", Some("Start")),
            ("LAMB", Some("Lamp")),
            ("stop1", Some("Stop")),
            ("tonp", Some("tonp1")),
            ("valve", None),
            ("", None),
            ("x", None),
        ] {
            assert_eq!(closest(name, names), expected, "{name}");
        }
    }
}
