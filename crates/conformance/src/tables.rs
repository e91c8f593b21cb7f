//! What else a compliance statement says, as tables of this project: values of what the standard
//! leaves to implementers, treatment of errors, extensions. Rows name the cases that show them.

use std::sync::LazyLock;

/// Something the standard leaves to implementers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Parameter {
    /// What is left open.
    pub item: String,
    /// What iecc does.
    pub choice: String,
    /// Cases that show it.
    pub cases: Vec<String>,
}

/// An error condition of the standard.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ErrorCondition {
    /// What is wrong.
    pub condition: String,
    /// How it is treated: 1 not reported, 2 reported when compiling, 3 reported when linking, 4 reported at
    /// run time.
    pub classes: Vec<u8>,
    /// What iecc does.
    pub treatment: String,
    /// Cases that show it.
    pub cases: Vec<String>,
}

/// Something that is not in the standard.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Extension {
    /// What it is.
    pub extension: String,
    /// How it is switched on or off.
    pub switch: String,
    /// Cases that show it.
    pub cases: Vec<String>,
}

/// All parameters.
pub fn parameters() -> &'static [Parameter] {
    static ROWS: LazyLock<Vec<Parameter>> = LazyLock::new(|| {
        rows(
            include_str!("../data/parameters.csv"),
            |[item, choice, cases]| Parameter {
                item: item.to_owned(),
                choice: choice.to_owned(),
                cases: names(cases),
            },
        )
    });
    &ROWS
}

/// All error conditions.
pub fn errors() -> &'static [ErrorCondition] {
    static ROWS: LazyLock<Vec<ErrorCondition>> = LazyLock::new(|| {
        rows(
            include_str!("../data/errors.csv"),
            |[condition, classes, treatment, cases]| ErrorCondition {
                condition: condition.to_owned(),
                classes: names(classes)
                    .iter()
                    .map(|class| class.parse().expect("a class is a number"))
                    .collect(),
                treatment: treatment.to_owned(),
                cases: names(cases),
            },
        )
    });
    &ROWS
}

/// All extensions.
pub fn extensions() -> &'static [Extension] {
    static ROWS: LazyLock<Vec<Extension>> = LazyLock::new(|| {
        rows(
            include_str!("../data/extensions.csv"),
            |[extension, switch, cases]| Extension {
                extension: extension.to_owned(),
                switch: switch.to_owned(),
                cases: names(cases),
            },
        )
    });
    &ROWS
}

fn names(cell: &str) -> Vec<String> {
    cell.split_whitespace().map(str::to_owned).collect()
}

/// The rows of a table of this crate, which is well-formed, behind its head.
pub(crate) fn rows<const N: usize, T>(text: &str, read: impl Fn([&str; N]) -> T) -> Vec<T> {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let records = reader.records().map(|record| {
        let record = record.expect("a well-formed table");
        let cells: Vec<&str> = record.iter().collect();
        read(cells.try_into().expect("as many cells as columns"))
    });
    records.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tables_are_complete() {
        assert!(!parameters().is_empty() && !extensions().is_empty());
        for row in errors() {
            assert!(!row.classes.is_empty(), "{}", row.condition);
            let known = row.classes.iter().all(|class| (1..=4).contains(class));
            assert!(known, "{}", row.condition);
        }
        for row in parameters() {
            assert!(!row.choice.is_empty(), "{}", row.item);
        }
        let errors = errors()
            .iter()
            .flat_map(|row| [&row.condition, &row.treatment]);
        let parameters = parameters().iter().flat_map(|row| [&row.item, &row.choice]);
        let extensions = extensions()
            .iter()
            .flat_map(|row| [&row.extension, &row.switch]);
        for text in errors.chain(parameters).chain(extensions) {
            assert!(!text.contains('|'), "a cell of Markdown: {text}");
        }
    }
}
