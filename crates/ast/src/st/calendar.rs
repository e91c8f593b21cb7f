//! The Gregorian calendar, also before it was introduced, as ISO 8601 counts.

/// Nanoseconds of a day.
pub const NS_PER_DAY: i64 = 86_400 * 1_000_000_000;

/// A day of the calendar.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Date {
    /// Year; 0 is the year before 1.
    pub year: i32,
    /// Month from 1.
    pub month: u32,
    /// Day from 1.
    pub day: u32,
}

impl Date {
    /// The day, if the month has it.
    pub fn new(year: i32, month: u32, day: u32) -> Option<Self> {
        let exists = (1..=12).contains(&month) && (1..=month_length(year, month)).contains(&day);
        exists.then_some(Self { year, month, day })
    }

    /// Days since 1970-01-01.
    ///
    /// Counts years from March on, so that the leap day is the last of its year.
    pub fn days_since_1970(self) -> i64 {
        let year = i64::from(self.year) - i64::from(self.month <= 2);
        let month = i64::from((self.month + 9) % 12);
        let day_of_year = (153 * month + 2) / 5 + i64::from(self.day) - 1;
        let leap_days = year.div_euclid(4) - year.div_euclid(100) + year.div_euclid(400);
        365 * year + leap_days + day_of_year - MARCH_0_TO_1970
    }

    /// The day so many days after 1970-01-01. Good for all days that 64 bits of nanoseconds reach.
    pub fn from_days_since_1970(days: i64) -> Self {
        let days = days + MARCH_0_TO_1970;
        let era = days.div_euclid(DAYS_PER_400_YEARS);
        let day_of_era = days.rem_euclid(DAYS_PER_400_YEARS);
        let leap_days = day_of_era / 1_460 - day_of_era / 36_524 + day_of_era / 146_096;
        let year_of_era = (day_of_era - leap_days) / 365;
        let first = 365 * year_of_era + year_of_era / 4 - year_of_era / 100;
        let day_of_year = day_of_era - first;
        let month = (5 * day_of_year + 2) / 153;
        let day = day_of_year - (153 * month + 2) / 5 + 1;
        let year = era * 400 + year_of_era + i64::from(month >= 10);
        Self {
            year: i32::try_from(year).expect("nanoseconds reach three centuries"),
            month: ((month + 2) % 12 + 1) as u32,
            day: day as u32,
        }
    }
}

const DAYS_PER_400_YEARS: i64 = 146_097;

/// Days from 1 March of the year 0 to 1970-01-01.
const MARCH_0_TO_1970: i64 = 719_468;

fn month_length(year: i32, month: u32) -> u32 {
    match month {
        2 if is_leap(year) => 29,
        2 => 28,
        4 | 6 | 9 | 11 => 30,
        _ => 31,
    }
}

fn is_leap(year: i32) -> bool {
    year % 4 == 0 && (year % 100 != 0 || year % 400 == 0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_are_those_of_the_calendar() {
        for (date, days) in [
            ((1970, 1, 1), 0),
            ((1969, 12, 31), -1),
            ((1970, 3, 1), 59),
            ((2000, 2, 29), 11_016),
            ((2000, 3, 1), 11_017),
            ((2038, 1, 19), 24_855),
            ((1900, 3, 1), -25_508),
        ] {
            let (year, month, day) = date;
            let date = Date::new(year, month, day).unwrap();
            assert_eq!(date.days_since_1970(), days, "{date:?}");
            assert_eq!(Date::from_days_since_1970(days), date);
        }
    }

    #[test]
    fn every_day_of_eight_centuries_follows_the_one_before() {
        let mut last = Date::from_days_since_1970(-146_097);
        for days in -146_096..146_097 {
            let date = Date::from_days_since_1970(days);
            let next = Date::new(last.year, last.month, last.day + 1)
                .or_else(|| Date::new(last.year, last.month + 1, 1))
                .or_else(|| Date::new(last.year + 1, 1, 1));
            assert_eq!(Some(date), next);
            assert_eq!(date.days_since_1970(), days);
            last = date;
        }
    }

    #[test]
    fn days_that_no_month_has_are_refused() {
        for (year, month, day) in [
            (2023, 2, 29),
            (1900, 2, 29),
            (2024, 4, 31),
            (2024, 13, 1),
            (2024, 0, 1),
            (2024, 1, 0),
        ] {
            assert_eq!(Date::new(year, month, day), None);
        }
    }
}
