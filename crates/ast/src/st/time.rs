//! Durations, dates and times of day as text and in nanoseconds.

use super::calendar::{Date, NS_PER_DAY};
use super::{TimeLiteral, TimeShape};
use crate::numbers::underlines_are_between_digits;

/// The value, or what is wrong with the text.
type Parsed<T> = Result<T, String>;

/// The value of the text behind the `#` of a literal.
///
/// # Errors
/// What is wrong with the text.
pub fn nanoseconds(shape: TimeShape, text: &str) -> Parsed<i64> {
    match shape {
        TimeShape::Duration => duration(text),
        TimeShape::Clock => clock(text),
        TimeShape::Date => at_midnight(text),
        TimeShape::DateAndClock => {
            let at = text.rfind('-').ok_or("the time of day is missing")?;
            let midnight = at_midnight(&text[..at])?;
            let ns = midnight.checked_add(clock(&text[at + 1..])?);
            ns.ok_or_else(out_of_range)
        }
    }
}

fn out_of_range() -> String {
    "the value is out of range: nanoseconds in 64 bits reach 292 years, and from 1677 to 2262"
        .to_owned()
}

fn at_midnight(text: &str) -> Parsed<i64> {
    let fields: Vec<&str> = text.split('-').collect();
    let [year, month, day] = fields[..] else {
        return Err("a date has a year, a month and a day".to_owned());
    };
    let year = i32::try_from(number(year)?).map_err(|_| out_of_range())?;
    let date = Date::new(year, small(month)?, small(day)?)
        .ok_or_else(|| format!("there is no day {text}"))?;
    let ns = date.days_since_1970().checked_mul(NS_PER_DAY);
    ns.ok_or_else(out_of_range)
}

fn clock(text: &str) -> Parsed<i64> {
    let fields: Vec<&str> = text.split(':').collect();
    let [hours, minutes, seconds] = fields[..] else {
        return Err("a time of day has hours, minutes and seconds".to_owned());
    };
    let (hours, minutes) = (small(hours)?, small(minutes)?);
    let seconds = scaled(seconds, UNITS[3].1)?;
    if hours >= 24 || minutes >= 60 || seconds >= 60 * u128::from(UNITS[3].1) {
        return Err(format!("there is no time of day {text}"));
    }
    let minutes = u128::from(hours * 60 + minutes);
    Ok((minutes * u128::from(UNITS[2].1) + seconds) as i64)
}

/// Units from large to small, with their nanoseconds and how many fit the next larger one.
const UNITS: [(&str, u64, u128); 7] = [
    ("d", 86_400_000_000_000, u128::MAX),
    ("h", 3_600_000_000_000, 24),
    ("m", 60_000_000_000, 60),
    ("s", 1_000_000_000, 60),
    ("ms", 1_000_000, 1000),
    ("us", 1_000, 1000),
    ("ns", 1, 1000),
];

/// Parts from large to small. The first may be larger than its unit has room for, the last may
/// have a fraction.
fn duration(text: &str) -> Parsed<i64> {
    let (negative, mut rest) = match text.strip_prefix('-') {
        Some(rest) => (true, rest),
        None => (false, text.strip_prefix('+').unwrap_or(text)),
    };
    let mut total: u128 = 0;
    let mut last_unit = None;
    while !rest.is_empty() || last_unit.is_none() {
        let part = part(rest)?;
        check_order(&part, last_unit)?;
        total = total.saturating_add(scaled(part.number, UNITS[part.unit].1)?);
        rest = behind(part.rest, part.number)?;
        last_unit = Some(part.unit);
    }
    let ns = i128::try_from(total).map_err(|_| out_of_range())?;
    let ns = if negative { -ns } else { ns };
    i64::try_from(ns).map_err(|_| out_of_range())
}

struct Part<'t> {
    number: &'t str,
    /// An index into `UNITS`.
    unit: usize,
    rest: &'t str,
}

fn part(text: &str) -> Parsed<Part<'_>> {
    let digits = |c: char| c.is_ascii_digit() || c == '.' || c == '_';
    let (number, rest) = split(text, digits);
    let (name, rest) = split(rest, |c| c.is_ascii_alphabetic());
    let known = UNITS
        .iter()
        .position(|unit| unit.0.eq_ignore_ascii_case(name));
    match known {
        _ if number.is_empty() => Err("a number is missing in the duration".to_owned()),
        _ if name.is_empty() => Err(format!("`{number}` has no unit")),
        Some(unit) => Ok(Part { number, unit, rest }),
        None => Err(format!(
            "`{name}` is not a unit of time: there are d, h, m, s, ms, us and ns"
        )),
    }
}

fn split(text: &str, belongs: impl Fn(char) -> bool) -> (&str, &str) {
    text.split_at(text.find(|c| !belongs(c)).unwrap_or(text.len()))
}

/// Units get smaller, and no part but the first fills the next larger unit.
fn check_order(part: &Part<'_>, last_unit: Option<usize>) -> Parsed<()> {
    let Some(last) = last_unit else {
        return Ok(());
    };
    let (name, ns, room) = UNITS[part.unit];
    if part.unit <= last {
        return Err(format!("`{name}` stands behind `{}`", UNITS[last].0));
    }
    if scaled(part.number, ns)? >= room * u128::from(ns) {
        let number = part.number;
        return Err(format!("`{number}{name}` is too much behind a larger unit"));
    }
    Ok(())
}

/// What follows a part: nothing may follow a fraction, one underline may stand between parts.
fn behind<'t>(rest: &'t str, number: &str) -> Parsed<&'t str> {
    if number.contains('.') && !rest.is_empty() {
        return Err("a part with a fraction is not the last one".to_owned());
    }
    match rest.strip_prefix('_') {
        Some("") => Err("the duration ends with an underline".to_owned()),
        Some(rest) => Ok(rest),
        None => Ok(rest),
    }
}

/// A number with an optional fraction, times a whole number.
fn scaled(text: &str, factor: u64) -> Parsed<u128> {
    let (whole, fraction) = match text.split_once('.') {
        Some((whole, fraction)) => (whole, fraction),
        None => (text, "0"),
    };
    let whole = u128::from(number(whole)?) * u128::from(factor);
    number(fraction.get(..1).unwrap_or_default())?;
    if !underlines_are_between_digits(fraction) {
        return Err(format!("`{text}` is not a number"));
    }
    let digits: String = fraction.chars().filter(char::is_ascii_digit).collect();
    let digits = digits.trim_end_matches('0');
    let scale = 10u128
        .checked_pow(digits.len() as u32)
        .filter(|_| digits.len() <= 18);
    let too_fine = || format!("`{text}` is not a whole number of nanoseconds");
    let scale = scale.ok_or_else(too_fine)?;
    let part = digits.parse::<u128>().unwrap_or(0) * u128::from(factor);
    if part % scale == 0 {
        Ok(whole + part / scale)
    } else {
        Err(too_fine())
    }
}

fn number(text: &str) -> Parsed<u64> {
    let is_number = underlines_are_between_digits(text)
        && text
            .bytes()
            .all(|byte| byte.is_ascii_digit() || byte == b'_');
    if !is_number {
        return Err(format!("`{text}` is not a number"));
    }
    text.replace('_', "").parse().map_err(|_| out_of_range())
}

/// A number with a few digits.
fn small(text: &str) -> Parsed<u32> {
    number(text)?.try_into().map_err(|_| out_of_range())
}

/// A duration or point in time as a literal that gives it back: largest units first, no parts that
/// are 0. The time of day of a date is not shown.
pub fn time_text(time: TimeLiteral) -> String {
    let value = match time.kind.shape() {
        TimeShape::Duration => duration_text(time.ns),
        TimeShape::Date => date_text(time.ns),
        TimeShape::Clock => clock_text(time.ns),
        TimeShape::DateAndClock => {
            let (date, clock) = (
                date_text(time.ns),
                clock_text(time.ns.rem_euclid(NS_PER_DAY)),
            );
            format!("{date}-{clock}")
        }
    };
    format!("{}#{value}", time.kind.prefix())
}

fn duration_text(ns: i64) -> String {
    let mut text = String::from(if ns < 0 { "-" } else { "" });
    let mut rest = ns.unsigned_abs();
    for (unit, size, _) in UNITS {
        if rest >= size {
            text.push_str(&format!("{}{unit}", rest / size));
            rest %= size;
        }
    }
    if ns == 0 {
        text.push_str("0s");
    }
    text
}

fn date_text(ns: i64) -> String {
    let Date { year, month, day } = Date::from_days_since_1970(ns.div_euclid(NS_PER_DAY));
    format!("{year:04}-{month:02}-{day:02}")
}

fn clock_text(ns: i64) -> String {
    let seconds = ns / 1_000_000_000;
    let (hours, minutes) = (seconds / 3600, seconds / 60 % 60);
    let fraction = format!("{:09}", ns % 1_000_000_000);
    let fraction = fraction.trim_end_matches('0');
    let point = if fraction.is_empty() { "" } else { "." };
    format!(
        "{hours:02}:{minutes:02}:{:02}{point}{fraction}",
        seconds % 60
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: i64 = 1_000_000;

    #[test]
    fn durations_add_their_parts() {
        for (text, ns) in [
            ("14ms", 14 * MS),
            ("-14ms", -14 * MS),
            ("14.7s", 14_700 * MS),
            ("14.7m", 882_000 * MS),
            ("14.7h", 52_920_000 * MS),
            ("14.7d", 1_270_080_000 * MS),
            ("25h15m", 90_900_000 * MS),
            ("5d14h12m18s3.5ms", 483_138_003_500_000),
            ("1d_2h", 93_600_000 * MS),
            ("1us2NS", 1_002),
            ("1_000ms", 1_000 * MS),
            ("0s", 0),
            ("-9223372036854775808ns", i64::MIN),
        ] {
            assert_eq!(duration(text), Ok(ns), "{text}");
        }
    }

    #[test]
    fn durations_that_mean_nothing_are_refused() {
        for text in [
            "",
            "5",
            "ms",
            "1h75m",
            "1m1h",
            "1.5h3m",
            "1x",
            "1s_",
            "1__0s",
            "1.s",
            ".5s",
            "0.5ns",
            "1s1s",
            "9223372036854775808ns",
            "999999999999999999999999d",
            "1s__2ms",
        ] {
            assert!(duration(text).is_err(), "{text}");
        }
    }

    #[test]
    fn dates_and_times_count_from_1970_and_midnight() {
        let day = NS_PER_DAY;
        assert_eq!(at_midnight("1970-01-02"), Ok(day));
        assert_eq!(at_midnight("1984-06-25"), Ok(5_289 * day));
        assert_eq!(clock("15:36:55.36"), Ok(56_215_360 * MS));
        let both = nanoseconds(TimeShape::DateAndClock, "1984-06-25-15:36:55.36");
        assert_eq!(both, Ok(5_289 * day + 56_215_360 * MS));
        assert_eq!(clock("23:59:59.999999999"), Ok(day - 1));
    }

    #[test]
    fn days_and_times_that_do_not_exist_are_refused() {
        for text in [
            "2023-02-29",
            "2024-13-01",
            "2024-01",
            "1500-01-01",
            "2024-1-x",
        ] {
            assert!(at_midnight(text).is_err(), "{text}");
        }
        for text in [
            "24:00:00",
            "12:60:00",
            "12:00:60",
            "12:00",
            "12:00:0.0000000001",
        ] {
            assert!(clock(text).is_err(), "{text}");
        }
    }
}
