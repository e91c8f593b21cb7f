//! The clock, and how many unit boundaries lie between two of its edges.
//!
//! With the period T and a unit U, scan k starts at time k·T, and `step U` in it is
//! ⌊k·T/U⌋ − ⌊(k−1)·T/U⌋, 0 in the first scan. A [`Divider`] computes that exactly: T/U is a
//! fraction in lowest terms, kept as whole units per clock plus a numerator that is summed up modulo
//! the denominator. No division is needed in hardware and the error never grows.

use std::fmt;

/// Clock frequency in hertz as a fraction, so that any period in whole nanoseconds is exact.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Clock {
    numerator: u64,
    denominator: u64,
}

impl Clock {
    /// `numerator / denominator` hertz; `None` unless both are positive.
    pub fn new(numerator: u64, denominator: u64) -> Option<Self> {
        let divisor = u64::try_from(gcd(u128::from(numerator), u128::from(denominator))).ok()?;
        (numerator > 0 && denominator > 0).then(|| Self {
            numerator: numerator / divisor,
            denominator: denominator / divisor,
        })
    }

    /// A whole number of hertz, at least 1.
    pub fn hertz(hertz: u64) -> Option<Self> {
        Self::new(hertz, 1)
    }

    /// One clock every `period_ns` nanoseconds, at least 1.
    pub fn period_ns(period_ns: u64) -> Option<Self> {
        Self::new(NS_PER_SECOND, period_ns)
    }

    /// The period, if it is a whole number of nanoseconds.
    pub fn whole_period_ns(self) -> Option<u64> {
        let (period, unit) = self.period_in(1);
        u64::try_from(period).ok().filter(|_| unit == 1)
    }

    /// The period over a unit, in lowest terms.
    fn period_in(self, unit_ns: u64) -> (u128, u128) {
        assert!(unit_ns > 0, "verified units are at least 1 ns");
        let period = u128::from(self.denominator) * u128::from(NS_PER_SECOND);
        let unit = u128::from(self.numerator) * u128::from(unit_ns);
        let divisor = gcd(period, unit);
        (period / divisor, unit / divisor)
    }
}

impl fmt::Display for Clock {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (n, d) = (self.numerator, self.denominator);
        match (n, d) {
            (_, 1) if n % 1_000_000 == 0 => write!(f, "{} MHz", n / 1_000_000),
            (_, 1) if n % 1_000 == 0 => write!(f, "{} kHz", n / 1_000),
            (_, 1) => write!(f, "{n} Hz"),
            _ => write!(f, "{n}/{d} Hz"),
        }
    }
}

const NS_PER_SECOND: u64 = 1_000_000_000;

fn gcd(a: u128, b: u128) -> u128 {
    let (mut a, mut b) = (a, b);
    while b > 0 {
        (a, b) = (b, a % b);
    }
    a
}

/// The most units `step` gives in one scan at one scan per clock.
pub fn max_step(clock: Clock, unit_ns: u64) -> u64 {
    let (period, unit) = clock.period_in(unit_ns);
    u64::try_from(period.div_ceil(unit)).unwrap_or(u64::MAX)
}

/// How the steps of one unit are made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Divider {
    /// Units that pass in every clock.
    pub(crate) whole: u64,
    /// What is left over per clock, as a fraction in lowest terms below 1.
    pub(crate) numerator: u64,
    /// At least 1; 1 if nothing is left over.
    pub(crate) denominator: u64,
}

impl Divider {
    /// The divider for a unit; `None` if its counter would need more than 64 bits.
    pub(crate) fn new(clock: Clock, unit_ns: u64) -> Option<Self> {
        let (period, unit) = clock.period_in(unit_ns);
        Some(Self {
            whole: u64::try_from(period / unit).ok()?,
            numerator: u64::try_from(period % unit).ok()?,
            denominator: u64::try_from(unit).ok()?,
        })
    }

    /// Whether each step is 0 or 1.
    pub(crate) fn is_tick(self) -> bool {
        self.whole == 0 || (self.whole == 1 && self.numerator == 0)
    }

    /// The largest step.
    pub(crate) fn max_step(self) -> u64 {
        self.whole.saturating_add(u64::from(self.numerator > 0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: u64 = 1_000_000;

    #[test]
    fn a_whole_ratio_is_a_plain_count() {
        let divider = Divider::new(Clock::hertz(50_000_000).unwrap(), MS).unwrap();
        assert_eq!(
            (divider.whole, divider.numerator, divider.denominator),
            (0, 1, 50_000)
        );
    }

    #[test]
    fn a_slow_clock_passes_whole_units() {
        let divider = Divider::new(Clock::hertz(100).unwrap(), MS).unwrap();
        assert_eq!((divider.whole, divider.numerator), (10, 0));
        // 1/300 s is 3 1/3 ms: steps of 3 and 4.
        let divider = Divider::new(Clock::hertz(300).unwrap(), MS).unwrap();
        assert_eq!(
            (divider.whole, divider.numerator, divider.denominator),
            (3, 1, 3)
        );
        assert_eq!(max_step(Clock::hertz(300).unwrap(), MS), 4);
    }

    #[test]
    fn periods_in_nanoseconds_are_exact() {
        assert_eq!(Clock::period_ns(20), Clock::hertz(50_000_000));
        // 83 ns: a millisecond is 12048 16/83 clocks.
        let divider = Divider::new(Clock::period_ns(83).unwrap(), MS).unwrap();
        assert_eq!((divider.numerator, divider.denominator), (83, MS));
        assert_eq!(max_step(Clock::period_ns(83).unwrap(), MS), 1);
    }

    #[test]
    fn nonsense_is_no_clock() {
        assert_eq!(Clock::hertz(0), None);
        assert_eq!(Clock::new(0, 0), None);
        assert_eq!(Clock::period_ns(0), None);
    }
}
