//! Boards: which pins exist, which ports they carry, and the files a tool needs.
//!
//! A board is data in a small text format, one item a line, `#` begins a comment:
//!
//! ```text
//! flow    quartus | icestorm          the tool
//! device  EP4CE115F29C7               its name for the chip
//! family  Cyclone_IV_E                and for the family or package
//! clock   CLOCK_50  Y2    3.3-V_LVTTL  50000000
//! reset   KEY0      M23   2.5_V        low
//! input   SW0       AB28  2.5_V        high
//! output  LEDR0     G19   2.5_V        high
//! ```
//!
//! `_` in a standard stands for a blank. `low` means that the pin is low when the signal is 1. A
//! user's pin file has lines `port Start SW3`, or `port Start SW3 low`, or a pin of its own:
//! `port Start AB22 3.3-V_LVTTL high`. A bit of a wider port is written `Speed.3`. Ports that are
//! not mentioned take the free inputs or outputs of the board in order.

mod assign;
mod files;
mod wrapper;

use crate::clock::Clock;
pub(crate) use assign::{Assignment, assign};
pub(crate) use files::files;
use std::fmt;

/// The boards that come with the compiler: name and pin file.
const BOARDS: &[(&str, &str)] = &[
    ("de2-115", include_str!("../boards/de2-115.pins")),
    ("hx8k", include_str!("../boards/hx8k.pins")),
];

/// The tool that makes a bit stream.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Flow {
    Quartus,
    Icestorm,
}

/// A pin of the chip.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Pin {
    /// Name on the board.
    name: String,
    /// Name on the chip.
    location: String,
    standard: String,
    active_low: bool,
}

/// A user's wish: this port (or `port.bit`) on that resource of the board or pin of its own.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Wish {
    port: String,
    target: String,
    standard: Option<String>,
    active_low: Option<bool>,
}

/// A board with a user's wishes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Board {
    name: String,
    flow: Flow,
    device: String,
    family: String,
    clock: Pin,
    clock_hz: u64,
    reset: Option<Pin>,
    inputs: Vec<Pin>,
    outputs: Vec<Pin>,
    wishes: Vec<Wish>,
}

/// A line of a pin file that is not understood.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PinFileError {
    /// From 1.
    pub line: usize,
    /// What is wrong.
    pub message: String,
}

impl fmt::Display for PinFileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}: {}", self.line, self.message)
    }
}

impl Board {
    /// Names of the boards that come with the compiler.
    pub fn names() -> impl Iterator<Item = &'static str> {
        BOARDS.iter().map(|(name, _)| *name)
    }

    /// The board with this name.
    pub fn named(name: &str) -> Option<Self> {
        let (name, text) = BOARDS.iter().find(|(known, _)| *known == name)?;
        Some(Self::parse(name, text).expect("the boards here are well-formed"))
    }

    /// A whole board from its pin file.
    ///
    /// # Errors
    /// The first line that is not understood, or what is missing, behind the last line.
    pub fn parse(name: &str, text: &str) -> Result<Self, PinFileError> {
        let mut builder = Builder::default();
        for (line, words) in lines(text) {
            builder
                .line(&words)
                .map_err(|message| PinFileError { line, message })?;
        }
        builder.finish(name).map_err(|message| PinFileError {
            line: text.lines().count() + 1,
            message,
        })
    }

    /// Adds the wishes of a user's pin file.
    ///
    /// # Errors
    /// The first line that is not understood.
    pub fn with_pins(mut self, text: &str) -> Result<Self, PinFileError> {
        for (line, words) in lines(text) {
            let wish = wish(&words).map_err(|message| PinFileError { line, message })?;
            self.wishes.push(wish);
        }
        Ok(self)
    }

    /// The clock on the board.
    pub fn clock(&self) -> Clock {
        Clock::hertz(self.clock_hz).expect("checked when the file was read")
    }
}

/// Lines with words, numbered from 1.
fn lines(text: &str) -> impl Iterator<Item = (usize, Vec<&str>)> {
    text.lines().enumerate().filter_map(|(index, line)| {
        let code = line.split('#').next().unwrap_or_default();
        let words: Vec<&str> = code.split_whitespace().collect();
        (!words.is_empty()).then_some((index + 1, words))
    })
}

fn wish(words: &[&str]) -> Result<Wish, String> {
    let (port, target, standard, active) = match words {
        ["port", port, target] => (port, target, None, None),
        ["port", port, target, active] => (port, target, None, Some(*active)),
        ["port", port, target, standard, active] => {
            (port, target, Some((*standard).to_owned()), Some(*active))
        }
        _ => return Err("expected `port NAME RESOURCE [STANDARD] [high|low]`".to_owned()),
    };
    Ok(Wish {
        port: (*port).to_owned(),
        target: (*target).to_owned(),
        standard,
        active_low: active.map(active_low).transpose()?,
    })
}

fn active_low(word: &str) -> Result<bool, String> {
    match word {
        "low" => Ok(true),
        "high" => Ok(false),
        _ => Err(format!("found `{word}`, expected `high` or `low`")),
    }
}

#[derive(Default)]
struct Builder {
    flow: Option<Flow>,
    device: Option<String>,
    family: Option<String>,
    clock: Option<(Pin, u64)>,
    reset: Option<Pin>,
    inputs: Vec<Pin>,
    outputs: Vec<Pin>,
}

impl Builder {
    fn line(&mut self, words: &[&str]) -> Result<(), String> {
        match words {
            ["flow", "quartus"] => self.flow = Some(Flow::Quartus),
            ["flow", "icestorm"] => self.flow = Some(Flow::Icestorm),
            ["device", device] => self.device = Some((*device).to_owned()),
            ["family", family] => self.family = Some(family.replace('_', " ")),
            ["clock", name, location, standard, hertz] => {
                let hertz = hertz.parse().ok().filter(|&hertz| hertz > 0);
                let hertz = hertz.ok_or("the frequency is a whole number of hertz")?;
                self.clock = Some((pin(name, location, standard, "high")?, hertz));
            }
            [
                kind @ ("reset" | "input" | "output"),
                name,
                location,
                standard,
                active,
            ] => {
                let pin = pin(name, location, standard, active)?;
                match *kind {
                    "reset" => self.reset = Some(pin),
                    "input" => self.inputs.push(pin),
                    _ => self.outputs.push(pin),
                }
            }
            _ => {
                return Err(
                    "expected `flow`, `device`, `family`, `clock`, `reset`, `input` or `output` with its \
                     columns"
                        .to_owned(),
                );
            }
        }
        Ok(())
    }

    fn finish(self, name: &str) -> Result<Board, String> {
        let (clock, clock_hz) = self.clock.ok_or("a line `clock` is missing")?;
        Ok(Board {
            name: name.to_owned(),
            flow: self.flow.ok_or("a line `flow` is missing")?,
            device: self.device.ok_or("a line `device` is missing")?,
            family: self.family.ok_or("a line `family` is missing")?,
            clock,
            clock_hz,
            reset: self.reset,
            inputs: self.inputs,
            outputs: self.outputs,
            wishes: Vec::new(),
        })
    }
}

fn pin(name: &str, location: &str, standard: &str, active: &str) -> Result<Pin, String> {
    Ok(Pin {
        name: name.to_owned(),
        location: location.to_owned(),
        standard: standard.replace('_', " "),
        active_low: active_low(active)?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn boards_use_every_pin_once() {
        for name in Board::names() {
            let board = Board::named(name).unwrap();
            let pins = board
                .inputs
                .iter()
                .chain(&board.outputs)
                .chain(&board.reset);
            let pins: Vec<&str> = pins
                .chain([&board.clock])
                .map(|pin| pin.location.as_str())
                .collect();
            let unique: BTreeSet<&str> = pins.iter().copied().collect();
            assert_eq!(unique.len(), pins.len(), "{name}");
        }
    }

    #[test]
    fn a_bad_line_is_named() {
        let error = Board::parse("x", "flow quartus\noutput A B C maybe\n").unwrap_err();
        assert_eq!(error.line, 2);
        assert_eq!(error.message, "found `maybe`, expected `high` or `low`");
        let error = Board::parse("x", "flow quartus\n").unwrap_err();
        assert_eq!(
            (error.line, error.message.as_str()),
            (2, "a line `clock` is missing")
        );
        let board = Board::named("hx8k").unwrap();
        assert_eq!(board.with_pins("Start SW0").unwrap_err().line, 1);
    }
}
