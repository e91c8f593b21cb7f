//! Which pin carries which bit of which port.

use super::{Board, Pin, Wish};
use crate::design::Design;
use iecc_target::{Refusal, TargetError};
use std::collections::{BTreeMap, BTreeSet};

/// A bit of a port and its pin.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Carried {
    /// Position among the ports of its direction.
    pub(super) port: usize,
    /// Which bit; ports of one bit have bit 0.
    pub(super) bit: u32,
    pub(super) pin: Pin,
}

/// The pins of all ports.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Assignment {
    pub(super) inputs: Vec<Carried>,
    pub(super) outputs: Vec<Carried>,
}

/// Gives every bit of every port a pin: the one the user wished, else the next free one.
pub(crate) fn assign(board: &Board, design: &Design) -> Result<Assignment, Vec<TargetError>> {
    let inputs: Vec<(&str, u32)> = design
        .inputs
        .iter()
        .map(|input| (input.port.name.as_str(), input.port.ty.bits()))
        .collect();
    let outputs: Vec<(&str, u32)> = design
        .outputs
        .iter()
        .map(|output| (output.port.name.as_str(), output.port.ty.bits()))
        .collect();
    let mut errors = unknown_ports(board, &inputs, &outputs);
    let mut taken = BTreeSet::from([board.clock.location.clone()]);
    taken.extend(board.reset.iter().map(|pin| pin.location.clone()));
    let inputs = direction(
        board,
        "input",
        &inputs,
        &board.inputs,
        &mut taken,
        &mut errors,
    );
    let outputs = direction(
        board,
        "output",
        &outputs,
        &board.outputs,
        &mut taken,
        &mut errors,
    );
    if errors.is_empty() {
        Ok(Assignment { inputs, outputs })
    } else {
        Err(errors)
    }
}

fn refusal(message: String) -> TargetError {
    TargetError {
        refusal: Refusal::Option,
        origin: None,
        message,
    }
}

/// `Speed.3` is bit 3 of a wide port; a port of one bit has no dot.
fn bit_name(name: &str, bits: u32, bit: u32) -> String {
    if bits == 1 {
        name.to_owned()
    } else {
        format!("{name}.{bit}")
    }
}

fn bit_names(ports: &[(&str, u32)]) -> Vec<(usize, u32, String)> {
    let bits = |(index, &(name, bits)): (usize, &(&str, u32))| {
        (0..bits)
            .map(|bit| (index, bit, bit_name(name, bits, bit)))
            .collect::<Vec<_>>()
    };
    ports.iter().enumerate().flat_map(bits).collect()
}

fn unknown_ports(
    board: &Board,
    inputs: &[(&str, u32)],
    outputs: &[(&str, u32)],
) -> Vec<TargetError> {
    let names: Vec<String> = [bit_names(inputs), bit_names(outputs)]
        .concat()
        .into_iter()
        .map(|(_, _, name)| name)
        .collect();
    let mut seen = BTreeSet::new();
    let mut errors = Vec::new();
    for Wish { port, .. } in &board.wishes {
        if !names.iter().any(|name| name.eq_ignore_ascii_case(port)) {
            let message = format!("the pin file assigns `{port}`, which is no port of the program");
            errors.push(refusal(message));
        } else if !seen.insert(port.to_ascii_lowercase()) {
            errors.push(refusal(format!("the pin file assigns `{port}` twice")));
        }
    }
    errors
}

fn direction(
    board: &Board,
    kind: &str,
    ports: &[(&str, u32)],
    resources: &[Pin],
    taken: &mut BTreeSet<String>,
    errors: &mut Vec<TargetError>,
) -> Vec<Carried> {
    let bits = bit_names(ports);
    let mut wished: BTreeMap<usize, Pin> = BTreeMap::new();
    for (position, (_, _, name)) in bits.iter().enumerate() {
        let wish = board
            .wishes
            .iter()
            .find(|w| w.port.eq_ignore_ascii_case(name));
        let Some(wish) = wish else { continue };
        let pin = wished_pin(wish, resources);
        if !taken.insert(pin.location.clone()) {
            errors.push(refusal(format!(
                "pin {} of port `{name}` is already taken",
                pin.location
            )));
        }
        wished.insert(position, pin);
    }
    let free: Vec<&Pin> = resources
        .iter()
        .filter(|pin| !taken.contains(&pin.location))
        .collect();
    let needed = bits.len() - wished.len();
    if needed > free.len() {
        let message = format!(
            "board {} has {} free {kind} pins, but {needed} bits of {kind} ports need one; assign pins \
             of your own in a pin file, or make fewer ports",
            board.name,
            free.len()
        );
        errors.push(refusal(message));
        return Vec::new();
    }
    let mut free = free.into_iter();
    let carried = bits
        .into_iter()
        .enumerate()
        .map(|(position, (port, bit, _))| {
            let pin = wished.remove(&position);
            let pin = pin.unwrap_or_else(|| free.next().expect("counted").clone());
            taken.insert(pin.location.clone());
            Carried { port, bit, pin }
        });
    carried.collect()
}

/// A resource by its name on the board, else a pin by its name on the chip.
fn wished_pin(wish: &Wish, resources: &[Pin]) -> Pin {
    let named = |pin: &&Pin| {
        pin.name.eq_ignore_ascii_case(&wish.target)
            || pin.location.eq_ignore_ascii_case(&wish.target)
    };
    let resource = resources.iter().find(named);
    let standard = resource
        .or(resources.first())
        .map(|pin| pin.standard.clone());
    Pin {
        name: wish.target.clone(),
        location: resource.map_or_else(|| wish.target.clone(), |pin| pin.location.clone()),
        standard: match &wish.standard {
            Some(standard) => standard.replace('_', " "),
            None => standard.unwrap_or_default(),
        },
        active_low: wish
            .active_low
            .unwrap_or_else(|| resource.is_some_and(|pin| pin.active_low)),
    }
}
