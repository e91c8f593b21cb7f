//! A Rockwell Logix project as an export holds it, whole or in part.
//!
//! Everything that bears on meaning is here, also what later stages refuse; layout of drawings,
//! security, trends and product descriptions are not. A partial export (`Use="Target"` on what is
//! exported, `Use="Context"` on what it refers to) has the same shape with most lists short.

use crate::rung;
use crate::{Initial, Name, Parameters};
use iecc_source::{MappedText, Span};

/// A whole export.
#[derive(Debug, Clone, PartialEq)]
pub struct Project {
    /// Revision of the software that wrote the file, as spelled (`19.01`).
    pub software_revision: Option<Name>,
    /// What was exported: `Controller`, `Program`, `Routine`, `Rung`, `DataType`, `Module`, ….
    pub target_type: Option<Name>,
    /// The name of what was exported.
    pub target_name: Option<Name>,
    /// Whether reference material surrounds the target.
    pub contains_context: bool,
    /// The controller; its name is empty in an export that has none.
    pub controller: Controller,
    /// User-defined types.
    pub data_types: Vec<DataType>,
    /// Add-On Instructions, encoded ones included.
    pub instructions: Vec<AddOnInstruction>,
    /// The I/O tree.
    pub modules: Vec<Module>,
    /// Controller-scope tags.
    pub tags: Vec<Tag>,
    /// Programs and equipment phases.
    pub programs: Vec<Program>,
    /// Tasks in file order.
    pub tasks: Vec<Task>,
    /// Connections between program parameters and other tags.
    pub parameter_connections: Vec<ParameterConnection>,
    /// The root element.
    pub span: Span,
}

/// The role of an element in a partial export.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Use {
    /// What was exported.
    Target,
    /// What the target refers to.
    Context,
}

/// Properties of the controller itself.
#[derive(Debug, Clone, PartialEq)]
pub struct Controller {
    /// Its name.
    pub name: Name,
    /// Its role.
    pub role: Option<Use>,
    /// Catalogue number, such as `1769-L32E`.
    pub processor: Option<Name>,
    /// Firmware revision.
    pub firmware: Option<(u32, u32)>,
    /// `SFCExecutionControl`, `SFCRestartPosition`, `SFCLastScan`, as written.
    pub sfc_options: [Option<Name>; 3],
    /// Whether overflow is reported as a minor fault.
    pub report_minor_overflow: bool,
    /// Program that handles major faults.
    pub major_fault_program: Option<Name>,
    /// Program that runs at power-up.
    pub power_loss_program: Option<Name>,
    /// The element.
    pub span: Span,
}

/// A description or comment; of several languages the first is kept.
pub type Description = Option<MappedText>;

/// A user-defined type.
#[derive(Debug, Clone, PartialEq)]
pub struct DataType {
    /// Its name.
    pub name: Name,
    /// Its role.
    pub role: Option<Use>,
    /// Whether it is a string type (`LEN`, `DATA`).
    pub is_string: bool,
    /// Members in storage order.
    pub members: Vec<DataMember>,
    /// What it is.
    pub description: Description,
    /// The element.
    pub span: Span,
}

/// A member of a user-defined type.
#[derive(Debug, Clone, PartialEq)]
pub struct DataMember {
    /// Its name.
    pub name: Name,
    /// Its type; `BIT` for one bit of a hidden member.
    pub data_type: Name,
    /// Array length; `None` for a scalar (the file's 0).
    pub dimension: Option<u32>,
    /// Display radix, as written.
    pub radix: Option<Name>,
    /// Storage that the user does not see.
    pub hidden: bool,
    /// For a `BIT`: the hidden member that holds it, and the bit.
    pub bit_of: Option<(Name, u32)>,
    /// What it is.
    pub description: Description,
    /// The element.
    pub span: Span,
}

/// An Add-On Instruction.
#[derive(Debug, Clone, PartialEq)]
pub struct AddOnInstruction {
    /// Its name.
    pub name: Name,
    /// Its role.
    pub role: Option<Use>,
    /// Its revision, as written.
    pub revision: Option<Name>,
    /// Parameters in definition order, `EnableIn` and `EnableOut` included.
    pub parameters: Vec<Parameter>,
    /// Local tags.
    pub locals: Vec<Tag>,
    /// `Logic`, and perhaps `Prescan`, `Postscan`, `EnableInFalse`.
    pub routines: Vec<Routine>,
    /// Whether routine `Prescan` runs in prescan.
    pub execute_prescan: bool,
    /// Whether routine `Postscan` runs in postscan.
    pub execute_postscan: bool,
    /// Whether routine `EnableInFalse` runs when the rung is false.
    pub execute_enable_in_false: bool,
    /// The content is encrypted: only the signature is known.
    pub encoded: bool,
    /// Safety-rated (`Class="Safety"`).
    pub safety: bool,
    /// What it is.
    pub description: Description,
    /// The element.
    pub span: Span,
}

/// A parameter of an Add-On Instruction.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// The direction.
    pub usage: Usage,
    /// Must be given in a call.
    pub required: bool,
    /// Shown on the instruction's face.
    pub visible: bool,
    /// Name, type, default value and alias.
    pub tag: Tag,
}

/// The direction of a parameter, or of a program's tag.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Usage {
    /// Copied in.
    Input,
    /// Copied out.
    Output,
    /// By reference.
    InOut,
    /// Program parameter open to every program.
    Public,
    /// Not a parameter.
    Local,
}

/// A tag, local tag or the tag part of a parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Tag {
    /// Its name.
    pub name: Name,
    /// Its role.
    pub role: Option<Use>,
    /// Where its value lives.
    pub kind: TagKind,
    /// Its type; an alias usually leaves it out.
    pub data_type: Option<Name>,
    /// Array lengths, outermost first; empty for a scalar.
    pub dimensions: Vec<u32>,
    /// Display radix, as written.
    pub radix: Option<Name>,
    /// Logic may not write it.
    pub constant: bool,
    /// For program tags: parameter direction.
    pub usage: Usage,
    /// Safety-rated (`Class="Safety"`).
    pub safety: bool,
    /// For a produced or consumed tag: the settings of its connection.
    pub connection: Option<Parameters>,
    /// What it is.
    pub description: Description,
    /// Comments on parts of the tag.
    pub comments: Vec<Comment>,
    /// Its value at export.
    pub initial: Initial,
    /// The element.
    pub span: Span,
}

/// Where a tag's value lives.
#[derive(Debug, Clone, PartialEq)]
pub enum TagKind {
    /// In its own storage.
    Base,
    /// It is another name for this operand text, such as `Local:2:I.Data.0`. `None` when the file
    /// does not say which (the tag is broken).
    Alias(Option<Name>),
    /// In its own storage, sent to other controllers.
    Produced,
    /// Received from another controller.
    Consumed,
}

/// A comment on a part of a tag.
#[derive(Debug, Clone, PartialEq)]
pub struct Comment {
    /// The part, as written: `.DATA.0`, `[3].Speed`; case may differ from the declaration.
    pub operand: Name,
    /// What it says.
    pub text: MappedText,
}

/// A module of the I/O tree.
#[derive(Debug, Clone, PartialEq)]
pub struct Module {
    /// Its name; may be empty or missing in context.
    pub name: Name,
    /// Its role.
    pub role: Option<Use>,
    /// Catalogue number.
    pub catalog_number: Option<Name>,
    /// The module it hangs on.
    pub parent: Option<Name>,
    /// The port of the parent it hangs on.
    pub parent_port: Option<u32>,
    /// Not connected.
    pub inhibited: bool,
    /// Its own ports.
    pub ports: Vec<Port>,
    /// Its input, output and configuration tags, under the names that programs use.
    pub tags: Vec<ModuleTag>,
    /// What it is.
    pub description: Description,
    /// The element.
    pub span: Span,
}

impl Module {
    /// The slot in the parent's chassis, where the module stands in one.
    pub fn slot(&self) -> Option<u32> {
        let port = self.ports.iter().find(|port| port.upstream)?;
        if port.is_network() {
            None
        } else {
            port.address.as_ref()?.node.parse().ok()
        }
    }

    /// What the module's tag names begin with: `Local:2` for slot 2 of the chassis `Local`, else
    /// the module's own name.
    pub fn tag_prefix(&self) -> String {
        match (self.slot(), &self.parent) {
            (Some(slot), Some(parent)) => format!("{}:{slot}", parent.node),
            (Some(_) | None, _) => self.name.node.clone(),
        }
    }
}

/// A port of a module.
#[derive(Debug, Clone, PartialEq)]
pub struct Port {
    /// Its number.
    pub id: Option<u32>,
    /// Slot or network address.
    pub address: Option<Name>,
    /// Kind of bus: `ICP`, `Compact`, `5094`, `Ethernet`, ….
    pub bus: Option<Name>,
    /// Leads towards the controller.
    pub upstream: bool,
}

impl Port {
    /// Whether addresses of the bus are network addresses rather than slots.
    pub fn is_network(&self) -> bool {
        const NETWORKS: [&str; 7] = [
            "Ethernet",
            "ControlNet",
            "DeviceNet",
            "RIO",
            "DHRIO",
            "DSI",
            "USB",
        ];
        let bus = self.bus.as_ref().map_or("", |bus| bus.node.as_str());
        NETWORKS
            .iter()
            .any(|network| network.eq_ignore_ascii_case(bus))
    }
}

/// One tag that a module brings.
#[derive(Debug, Clone, PartialEq)]
pub struct ModuleTag {
    /// The full name: `Local:2:I`. Spans the text it comes from (suffix, else module name).
    pub name: Name,
    /// What it carries.
    pub direction: ModuleTagDirection,
    /// The module-defined type as the data spells it (`AB:1769_DI16:I:0`), where there is data.
    pub data_type: Option<String>,
    /// The tag is a part of the rack adapter's tag rather than storage of its own.
    pub rack_alias: bool,
    /// Requested packet interval of its connection, in microseconds.
    pub packet_interval_us: Option<u32>,
    /// Its value at export.
    pub initial: Initial,
    /// Comments on points.
    pub comments: Vec<Comment>,
    /// The element.
    pub span: Span,
}

/// What a module tag carries.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ModuleTagDirection {
    /// From the module.
    Input,
    /// To the module.
    Output,
    /// Settings.
    Configuration,
}

/// A program or equipment phase.
#[derive(Debug, Clone, PartialEq)]
pub struct Program {
    /// Its name.
    pub name: Name,
    /// Its role.
    pub role: Option<Use>,
    /// The routine that is run.
    pub main_routine: Option<Name>,
    /// The routine that runs on a fault.
    pub fault_routine: Option<Name>,
    /// Test edits are active: inserted rungs are live, not the ones they replace.
    pub test_edits: bool,
    /// Not run.
    pub disabled: bool,
    /// Groups other programs only.
    pub is_folder: bool,
    /// An equipment phase, whose routines are states.
    pub is_phase: bool,
    /// Safety-rated (`Class="Safety"`).
    pub safety: bool,
    /// Program-scope tags.
    pub tags: Vec<Tag>,
    /// Routines, encoded ones included.
    pub routines: Vec<Routine>,
    /// What it is.
    pub description: Description,
    /// The element.
    pub span: Span,
}

/// A routine.
#[derive(Debug, Clone, PartialEq)]
pub struct Routine {
    /// Its name.
    pub name: Name,
    /// Its role.
    pub role: Option<Use>,
    /// What is in it.
    pub body: RoutineBody,
    /// What it is.
    pub description: Description,
    /// The element.
    pub span: Span,
}

/// The content of a routine.
#[derive(Debug, Clone, PartialEq)]
pub enum RoutineBody {
    /// Relay ladder; no rungs where the file leaves the content out.
    Ladder(Vec<Rung>),
    /// Structured text, line by line.
    StructuredText(StContent),
    /// A function block diagram, not read further.
    FunctionBlock(Span),
    /// A sequential function chart, not read further.
    SequentialChart(Span),
    /// Encrypted content.
    Encoded(Span),
    /// A kind this reader does not know, as written, or none at all.
    Unknown(Option<Name>),
}

/// A rung as the file holds it.
#[derive(Debug, Clone, PartialEq)]
pub struct Rung {
    /// Its number; as written, else its position.
    pub number: u32,
    /// Its edit state.
    pub kind: RungKind,
    /// What it says.
    pub comment: Description,
    /// The neutral text, trimmed.
    pub text: MappedText,
    /// The parsed text; `None` after a syntax error, which was reported.
    pub body: Option<rung::Rung>,
    /// The element.
    pub span: Span,
}

/// The edit state of a rung (`Type`).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RungKind {
    /// `N`
    Normal,
    /// `I`
    Insert,
    /// `D`
    Delete,
    /// `IR`: stands before the `R` that it replaces.
    InsertReplace,
    /// `R`
    Replace,
    /// `rR`: pending replacement of a replaced rung.
    PendingReplaceReplace,
    /// `rI`: pending replacement of an inserted rung.
    PendingReplaceInsert,
    /// `rN`: pending replacement of a normal rung.
    PendingReplaceNormal,
    /// `e`: pending insertion.
    PendingInsert,
    /// `er`: pending replacement.
    PendingReplace,
    /// `dN`, or `d` alone: pending deletion of a normal rung.
    PendingDeleteNormal,
    /// `dD`
    PendingDeleteDelete,
    /// `dI`
    PendingDeleteInsert,
    /// `dIR`
    PendingDeleteInsertReplace,
}

impl RungKind {
    /// The kind with this spelling, which is case-sensitive (`rR`).
    pub fn parse(text: &str) -> Option<Self> {
        Some(match text {
            "N" => Self::Normal,
            "I" => Self::Insert,
            "D" => Self::Delete,
            "IR" => Self::InsertReplace,
            "R" => Self::Replace,
            "rR" => Self::PendingReplaceReplace,
            "rI" => Self::PendingReplaceInsert,
            "rN" => Self::PendingReplaceNormal,
            "e" => Self::PendingInsert,
            "er" => Self::PendingReplace,
            "d" | "dN" => Self::PendingDeleteNormal,
            "dD" => Self::PendingDeleteDelete,
            "dI" => Self::PendingDeleteInsert,
            "dIR" => Self::PendingDeleteInsertReplace,
            _ => return None,
        })
    }

    /// Whether the controller executes the rung, with or without its test edits active.
    pub fn is_live(self, test_edits: bool) -> bool {
        match self {
            Self::Normal | Self::PendingReplaceNormal | Self::PendingDeleteNormal => true,
            Self::Delete
            | Self::PendingDeleteDelete
            | Self::Replace
            | Self::PendingReplaceReplace => !test_edits,
            Self::Insert
            | Self::PendingReplaceInsert
            | Self::PendingDeleteInsert
            | Self::InsertReplace
            | Self::PendingDeleteInsertReplace => test_edits,
            Self::PendingInsert | Self::PendingReplace => false,
        }
    }
}

/// The versions of a structured text routine. Without pending edits there is the original only.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct StContent {
    /// The accepted text; it runs unless test edits are active.
    pub original: Vec<StLine>,
    /// The text that runs while the program's test edits are active.
    pub test_edits: Option<Vec<StLine>>,
    /// A text that was not accepted yet; it never runs.
    pub pending_edits: Option<Vec<StLine>>,
}

/// A line of structured text.
#[derive(Debug, Clone, PartialEq)]
pub struct StLine {
    /// Its number; as written, else its position.
    pub number: u32,
    /// The text without line end.
    pub text: MappedText,
}

/// A task.
#[derive(Debug, Clone, PartialEq)]
pub struct Task {
    /// Its name.
    pub name: Name,
    /// When it runs.
    pub kind: TaskKind,
    /// 1 (highest) to 15.
    pub priority: Option<u32>,
    /// Longest run before a major fault.
    pub watchdog_ms: Option<Name>,
    /// Outputs are not sent at its end.
    pub disable_update_outputs: bool,
    /// Not run.
    pub inhibited: bool,
    /// Programs in the order they run.
    pub programs: Vec<Name>,
    /// What it is.
    pub description: Description,
    /// The element.
    pub span: Span,
}

/// When a task runs.
#[derive(Debug, Clone, PartialEq)]
pub enum TaskKind {
    /// Again and again, in the time that other tasks leave.
    Continuous,
    /// Every so many milliseconds, as written (may have a fraction).
    Periodic {
        /// The period.
        rate_ms: Option<Name>,
    },
    /// On a trigger.
    Event {
        /// What triggers it, as written.
        trigger: Option<Name>,
        /// The tag of a tag trigger.
        trigger_tag: Option<Name>,
        /// Also runs when this time passes without a trigger, where `timeout_enabled`.
        timeout_ms: Option<Name>,
        /// Whether the timeout counts.
        timeout_enabled: bool,
    },
    /// A kind this reader does not know, as written, or none at all.
    Unknown(Option<Name>),
}

/// A connection between two parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct ParameterConnection {
    /// One end, as written: `\Program.Tag`.
    pub endpoints: [Name; 2],
    /// The element.
    pub span: Span,
}
