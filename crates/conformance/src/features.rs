//! The feature tables of the standard, as rows of one table in `data/features.csv`.
//!
//! Edition 2 rows name the row of edition 3 that means the same: a case that covers the newer row
//! proves the older one as well.

use std::fmt;
use std::sync::LazyLock;

/// An edition of the standard.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Edition {
    /// Of 2003.
    Two,
    /// Of 2013.
    Three,
}

impl Edition {
    /// Its short name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Two => "ed2",
            Self::Three => "ed3",
        }
    }
}

/// Names a row: `ed3:71:8`.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct FeatureId {
    /// The edition.
    pub edition: Edition,
    /// The number of the table.
    pub table: String,
    /// The number of the feature.
    pub feature: String,
}

impl FeatureId {
    /// Reads an id; whether there is such a row is another question.
    pub fn parse(text: &str) -> Option<Self> {
        let mut parts = text.split(':');
        let edition = match parts.next()? {
            "ed2" => Edition::Two,
            "ed3" => Edition::Three,
            _ => return None,
        };
        let (table, feature) = (parts.next()?.to_owned(), parts.next()?.to_owned());
        parts.next().is_none().then_some(Self {
            edition,
            table,
            feature,
        })
    }
}

impl fmt::Display for FeatureId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}:{}", self.edition.name(), self.table, self.feature)
    }
}

/// A row of a feature table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Feature {
    /// Its number.
    pub id: FeatureId,
    /// What its table is about.
    pub title: String,
    /// What it is.
    pub text: String,
    /// For rows of edition 2: the row of edition 3 that means the same.
    pub newer: Option<FeatureId>,
}

/// All rows, in the order of the standard.
pub fn features() -> &'static [Feature] {
    static FEATURES: LazyLock<Vec<Feature>> =
        LazyLock::new(|| crate::tables::rows(include_str!("../data/features.csv"), read));
    &FEATURES
}

fn read(cells: [&str; 6]) -> Feature {
    let [edition, table, title, feature, text, newer] = cells;
    let id = |text: &str| FeatureId::parse(text).expect("an id");
    Feature {
        id: id(&format!("{edition}:{table}:{feature}")),
        title: title.to_owned(),
        text: text.to_owned(),
        newer: (!newer.is_empty()).then(|| id(newer)),
    }
}

/// The row of an id.
pub(crate) fn feature(id: &FeatureId) -> Option<&'static Feature> {
    features().iter().find(|feature| feature.id == *id)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_row_has_a_number_of_its_own() {
        let ids: BTreeSet<&FeatureId> = features().iter().map(|feature| &feature.id).collect();
        assert_eq!(ids.len(), features().len());
    }

    #[test]
    fn older_rows_name_newer_ones_that_exist() {
        for row in features() {
            if let Some(newer) = &row.newer {
                assert_eq!(
                    (row.id.edition, newer.edition),
                    (Edition::Two, Edition::Three)
                );
                assert!(feature(newer).is_some(), "{} names {newer}", row.id);
            }
        }
    }

    #[test]
    fn ids_are_read_as_they_are_written() {
        for text in ["ed3:71:16a", "ed2:3a:1", "ed3:19:-"] {
            assert_eq!(FeatureId::parse(text).unwrap().to_string(), text);
        }
        for text in ["ed4:1:1", "ed3:1", "ed3:1:2:3", ""] {
            assert_eq!(FeatureId::parse(text), None, "{text}");
        }
    }
}
