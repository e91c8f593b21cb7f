//! "Did you mean": the nearest known name to a misspelt one.

/// The candidate that differs from `name` in at most a third of its letters, if there is one.
/// Upper and lower case count as the same; the first of equals wins.
pub(crate) fn nearest<'c>(
    name: &str,
    candidates: impl IntoIterator<Item = &'c str>,
) -> Option<&'c str> {
    let name: Vec<char> = name.to_ascii_lowercase().chars().collect();
    // Longer names are not typed by hand; the bound keeps the table of distances small.
    if name.len() > 64 {
        return None;
    }
    let allowed = name.len().div_ceil(3).min(3);
    candidates
        .into_iter()
        .filter(|candidate| candidate.len().abs_diff(name.len()) <= allowed)
        .map(|candidate| (distance(&name, candidate), candidate))
        .filter(|(distance, _)| *distance <= allowed && *distance < name.len())
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate)
}

/// Levenshtein distance, row by row.
fn distance(name: &[char], candidate: &str) -> usize {
    let mut row: Vec<usize> = (0..=name.len()).collect();
    for (i, c) in candidate.to_ascii_lowercase().chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, n) in name.iter().enumerate() {
            let above = row[j + 1];
            row[j + 1] = (above + 1)
                .min(row[j] + 1)
                .min(diagonal + usize::from(*n != c));
            diagonal = above;
        }
    }
    row[name.len()]
}

#[cfg(test)]
mod tests {
    use super::nearest;

    #[test]
    fn the_nearest_name_is_found() {
        assert_eq!(nearest("tonp2", ["tonp1", "motor"]), Some("tonp1"));
        assert_eq!(nearest("MOTR", ["tonp1", "Motor"]), Some("Motor"));
        assert_eq!(nearest("pump", ["valve", "x"]), None);
        assert_eq!(nearest("x", ["y", "z"]), None, "nothing in common");
    }
}
