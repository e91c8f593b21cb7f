//! What passes may assume about how the program will run.

/// Facts about the scans to come.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Settings {
    /// The longest time from one scan to the next, rounded up to whole nanoseconds; `None` if
    /// nothing is known.
    pub longest_period_ns: Option<u64>,
}

impl Settings {
    /// The most boundaries of a unit that can lie between two scans.
    pub fn max_step(&self, unit_ns: u64) -> u64 {
        self.longest_period_ns
            .map_or(u64::MAX, |period| period.div_ceil(unit_ns.max(1)))
    }
}
