//! Initial values of tags, in the forms an export gives them.
//!
//! One tag may carry several forms of the same value. `Decorated` is the only one with names and
//! is the one to use; but for an instance of an Add-On Instruction it lacks the local tags, which
//! only the L5K and hex forms hold, in storage order.

use crate::Name;
use iecc_source::{Span, Spanned};

/// All forms of one tag's value that the file gives.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Initial {
    /// The tree with names.
    pub decorated: Option<Value>,
    /// The bracketed list in storage order.
    pub l5k: Option<L5kValue>,
    /// The form `<Data Format="String">` of string tags.
    pub string: Option<StringData>,
    /// The raw memory image, little endian, of files before L5K was written.
    pub hex: Option<Spanned<Vec<u8>>>,
    /// The attributes of `Message`, `Axis`, `Alarm…` and similar data, with the format's name.
    pub parameters: Option<Parameters>,
    /// Where force values stand, which take effect only when forces are enabled; not read.
    pub forces: Option<Span>,
}

/// Data that is a list of attributes (`MessageParameters`, `AlarmDigitalParameters`, …).
#[derive(Debug, Clone, PartialEq)]
pub struct Parameters {
    /// The element's name.
    pub element: Name,
    /// Attribute names and values in file order.
    pub attributes: Vec<(String, Name)>,
}

/// A string tag's text.
#[derive(Debug, Clone, PartialEq)]
pub struct StringData {
    /// The declared length, if readable.
    pub length: Option<u32>,
    /// The text with its quotes and escapes, as written.
    pub text: Name,
}

/// A value with names.
#[derive(Debug, Clone, PartialEq)]
pub struct Value {
    /// The data type as spelled; empty where the file leaves it to the declaration.
    pub data_type: String,
    /// What is there.
    pub kind: ValueKind,
    /// The element.
    pub span: Span,
}

/// The forms of a [`Value`].
#[derive(Debug, Clone, PartialEq)]
pub enum ValueKind {
    /// A number, date, or quoted characters, as text in the radix of the tag; see
    /// [`parse_number`](crate::parse_number).
    Scalar(Name),
    /// Members in file order.
    Struct(Vec<(Name, Value)>),
    /// Elements in file order, each with its indexes (one to three).
    Array {
        /// Declared lengths.
        dimensions: Vec<u32>,
        /// Elements that the file gives.
        elements: Vec<(Vec<u32>, Value)>,
    },
}

/// A value as bracketed list in storage order.
#[derive(Debug, Clone, PartialEq)]
pub enum L5kValue {
    /// A number or a quoted string, as written.
    Scalar(Name),
    /// `[…]`
    List(Vec<L5kValue>, Span),
}
