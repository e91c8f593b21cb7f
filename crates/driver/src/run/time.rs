//! Durations as users write them, and the times at which scans happen.

use iecc_diag::{Code, Diagnostic};

/// Times must fit a signed 64-bit number of nanoseconds, which is how programs see them.
pub(super) const MAX_NS: u64 = i64::MAX as u64;

/// Units of time, the largest first, and their nanoseconds.
const UNITS: [(&str, u64); 6] = [
    ("h", 3_600_000_000_000),
    ("m", 60_000_000_000),
    ("s", 1_000_000_000),
    ("ms", 1_000_000),
    ("us", 1_000),
    ("ns", 1),
];

/// Reads a duration such as `300s`, `10ms`, `1m30s` or `0.5s`, in nanoseconds.
///
/// # Errors
/// E6001 with what is wrong.
pub fn parse_duration(text: &str) -> Result<u64, Diagnostic> {
    duration(&text.to_ascii_lowercase()).map_err(|what| {
        Diagnostic::without_place(Code::E6001, format!("`{text}` is no duration: {what}"))
            .note("write a number and a unit, for example 300s, 10ms, 500us, 1m30s or 2h")
    })
}

fn duration(text: &str) -> Result<u64, String> {
    let (mut rest, mut sum, mut smallest) = (text, 0u64, u64::MAX);
    if rest.is_empty() {
        return Err("it is empty".to_owned());
    }
    while !rest.is_empty() {
        let (number, tail) = split_while(rest, |c| c.is_ascii_digit() || c == '.');
        let (unit, tail) = split_while(tail, |c| c.is_ascii_alphabetic());
        let found = UNITS.iter().find(|(name, _)| *name == unit);
        let Some(&(_, unit_ns)) = found else {
            return Err(match unit {
                "" => "a unit is missing".to_owned(),
                _ => format!("`{unit}` is no unit"),
            });
        };
        if unit_ns >= smallest {
            return Err(format!("`{unit}` comes after a unit that is not larger"));
        }
        let part = decimal(number, unit_ns)?;
        sum = sum.checked_add(part).ok_or("it is too long")?;
        (rest, smallest) = (tail, unit_ns);
    }
    if sum > MAX_NS {
        Err("it is too long".to_owned())
    } else {
        Ok(sum)
    }
}

fn split_while(text: &str, keep: impl Fn(char) -> bool) -> (&str, &str) {
    text.split_at(text.find(|c| !keep(c)).unwrap_or(text.len()))
}

/// A decimal number, not negative, times a unit; it must be a whole number of nanoseconds.
pub(super) fn decimal(number: &str, unit_ns: u64) -> Result<u64, String> {
    let (whole, fraction) = number.split_once('.').unwrap_or((number, "0"));
    let digits = |part: &str| !part.is_empty() && part.bytes().all(|b| b.is_ascii_digit());
    if !digits(whole) || !digits(fraction) {
        return Err("a number is missing or malformed".to_owned());
    }
    let whole: u64 = whole.parse().map_err(|_| "it is too long")?;
    let mut sum = whole.checked_mul(unit_ns).ok_or("it is too long")?;
    let mut worth = unit_ns;
    for digit in fraction.trim_end_matches('0').bytes() {
        if !worth.is_multiple_of(10) {
            return Err("it is no whole number of nanoseconds".to_owned());
        }
        worth /= 10;
        sum = sum
            .checked_add(worth * u64::from(digit - b'0'))
            .ok_or("it is too long")?;
    }
    if sum > MAX_NS {
        Err("it is too long".to_owned())
    } else {
        Ok(sum)
    }
}

/// The unit in which times are written: the largest of these of which every scan is a multiple.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TimeUnit {
    /// Milliseconds.
    Milliseconds,
    /// Microseconds.
    Microseconds,
    /// Nanoseconds.
    Nanoseconds,
}

impl TimeUnit {
    /// All, the largest first.
    pub const ALL: [Self; 3] = [Self::Milliseconds, Self::Microseconds, Self::Nanoseconds];

    /// Its length.
    pub fn nanoseconds(self) -> u64 {
        match self {
            Self::Milliseconds => 1_000_000,
            Self::Microseconds => 1_000,
            Self::Nanoseconds => 1,
        }
    }

    /// The head of a column with times in this unit.
    pub fn column(self) -> &'static str {
        match self {
            Self::Milliseconds => "t_ms",
            Self::Microseconds => "t_us",
            Self::Nanoseconds => "t_ns",
        }
    }
}

/// Scans at 0, one period, two periods and so on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Schedule {
    period_ns: u64,
    scans: u64,
}

impl Schedule {
    /// A number of scans.
    ///
    /// # Errors
    /// E6002 if the period is 0 or the last scan is too late.
    pub fn for_scans(period_ns: u64, scans: u64) -> Result<Self, Diagnostic> {
        let refuse = |what: &str| Err(Diagnostic::without_place(Code::E6002, what));
        if period_ns == 0 {
            return refuse("the period between scans is 0");
        }
        let last = scans.saturating_sub(1).checked_mul(period_ns);
        if last.is_none_or(|last| last > MAX_NS) {
            return refuse("the last scan would be later than 63 bits of nanoseconds can say");
        }
        Ok(Self { period_ns, scans })
    }

    /// All scans before `length_ns`.
    ///
    /// # Errors
    /// E6002 if the period is 0.
    pub fn for_duration(period_ns: u64, length_ns: u64) -> Result<Self, Diagnostic> {
        Self::for_scans(period_ns, length_ns.div_ceil(period_ns.max(1)))
    }

    /// How many scans there are.
    pub fn scans(self) -> u64 {
        self.scans
    }

    /// The time between two scans.
    pub fn period_ns(self) -> u64 {
        self.period_ns
    }

    /// The time of a scan, counted from 0.
    pub fn time_ns(self, scan: u64) -> u64 {
        scan * self.period_ns
    }

    /// The largest unit that all scans are multiples of.
    pub fn unit(self) -> TimeUnit {
        let fits = |unit: &TimeUnit| self.period_ns.is_multiple_of(unit.nanoseconds());
        TimeUnit::ALL
            .into_iter()
            .find(fits)
            .expect("1 ns divides everything")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn durations_are_sums_of_numbers_with_units() {
        for (text, ns) in [
            ("300s", 300_000_000_000),
            ("10ms", 10_000_000),
            ("500us", 500_000),
            ("1m30s", 90_000_000_000),
            ("2H", 7_200_000_000_000),
            ("0.5s", 500_000_000),
            ("1.25us", 1_250),
            ("1.50ms", 1_500_000),
            ("7ns", 7),
            ("0s", 0),
        ] {
            assert_eq!(parse_duration(text).unwrap(), ns, "{text}");
        }
    }

    #[test]
    fn what_is_no_duration_is_refused_with_the_reason() {
        for (text, reason) in [
            ("", "it is empty"),
            ("10", "a unit is missing"),
            ("ms", "a number is missing or malformed"),
            ("1.s", "a number is missing or malformed"),
            ("1.2.3s", "a number is missing or malformed"),
            ("-1s", "a unit is missing"),
            ("10 parsecs", "a unit is missing"),
            ("10parsecs", "`parsecs` is no unit"),
            ("30s1m", "`m` comes after a unit that is not larger"),
            ("1s1s", "`s` comes after a unit that is not larger"),
            ("0.5ns", "it is no whole number of nanoseconds"),
            ("99999999h", "it is too long"),
            ("99999999999999999999h", "it is too long"),
        ] {
            let error = parse_duration(text).unwrap_err();
            assert_eq!(error.message, format!("`{text}` is no duration: {reason}"));
            assert_eq!(error.code, Code::E6001);
        }
    }

    #[test]
    fn scans_happen_at_0_and_every_period_before_the_end() {
        const MS: u64 = 1_000_000;
        let count = |period, length| Schedule::for_duration(period, length).unwrap().scans();
        assert_eq!(count(10 * MS, 300_000 * MS), 30_000);
        assert_eq!(count(10 * MS, 10 * MS), 1);
        assert_eq!(count(10 * MS, 10 * MS + 1), 2);
        assert_eq!(count(10 * MS, 0), 0);
        let schedule = Schedule::for_scans(2_500_000, 3).unwrap();
        assert_eq!(schedule.time_ns(2), 5 * MS);
        assert_eq!(schedule.unit(), TimeUnit::Microseconds);
        for (period, scans) in [(0, 1), (u64::MAX, 2), (1 << 62, 3)] {
            assert_eq!(
                Schedule::for_scans(period, scans).unwrap_err().code,
                Code::E6002
            );
        }
        assert_eq!(Schedule::for_duration(0, 5).unwrap_err().code, Code::E6002);
    }
}
