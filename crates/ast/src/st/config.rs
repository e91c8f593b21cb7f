//! Configurations: resources, tasks, program instances, access paths, VAR_CONFIG.

use super::arena::{Id, List};
use super::decl::{Modifier, TypeSpec, VarSection};
use super::expr::{Argument, Expr, Ident};
use iecc_source::TextRange;

/// `CONFIGURATION … END_CONFIGURATION`
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Configuration {
    /// Its name.
    pub name: Ident,
    /// VAR_GLOBAL, VAR_ACCESS, VAR_CONFIG and VAR_EXTERNAL.
    pub sections: List<VarSection>,
    /// The resources. Tasks and programs outside of RESOURCE belong to one without a name, which
    /// is then the first.
    pub resources: List<Resource>,
    /// All of it.
    pub range: TextRange,
}

/// `RESOURCE … ON … END_RESOURCE`
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Resource {
    /// Its name; `None` where the configuration leaves RESOURCE out.
    pub name: Option<Ident>,
    /// The kind of processor.
    pub on: Option<Ident>,
    /// VAR_GLOBAL and VAR_EXTERNAL.
    pub sections: List<VarSection>,
    /// The tasks.
    pub tasks: List<Task>,
    /// The program instances.
    pub programs: List<ProgramConfig>,
    /// All of it.
    pub range: TextRange,
}

/// `TASK name (INTERVAL := …, PRIORITY := …);`
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Task {
    /// Its name.
    pub name: Ident,
    /// SINGLE, INTERVAL, PRIORITY.
    pub parameters: List<Argument>,
    /// All of it.
    pub range: TextRange,
}

/// `PROGRAM name WITH task : type (…);`
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProgramConfig {
    /// RETAIN or NON_RETAIN.
    pub modifiers: List<Modifier>,
    /// The name of the instance.
    pub name: Ident,
    /// The task that runs it.
    pub task: Option<Ident>,
    /// The program: a path.
    pub program: Id<Expr>,
    /// What it is connected to.
    pub elements: List<ProgramElement>,
    /// All of it.
    pub range: TextRange,
}

/// An element in the parentheses of a program instance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ProgramElement {
    /// `input := source`
    Source {
        /// A variable of the program.
        variable: Id<Expr>,
        /// What it gets.
        source: Id<Expr>,
    },
    /// `output => sink`
    Sink {
        /// A variable of the program.
        variable: Id<Expr>,
        /// What gets it.
        sink: Id<Expr>,
    },
    /// `block WITH task`
    Task {
        /// A function block instance in the program.
        block: Id<Expr>,
        /// The task that runs it.
        task: Ident,
    },
}

/// `name : path : type READ_WRITE;`
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AccessDecl {
    /// The name others see.
    pub name: Ident,
    /// The variable.
    pub path: Id<Expr>,
    /// Its type.
    pub ty: Id<TypeSpec>,
    /// READ_ONLY or READ_WRITE.
    pub direction: Option<AccessDirection>,
    /// All of it.
    pub range: TextRange,
}

/// What may be done through an access path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AccessDirection {
    /// READ_ONLY.
    ReadOnly,
    /// READ_WRITE.
    ReadWrite,
}

/// `resource.program.block.variable AT %QB25 : BYTE := 1;`
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InstanceConfig {
    /// The variable.
    pub path: Id<Expr>,
    /// Its address.
    pub location: Option<Id<Expr>>,
    /// Its type.
    pub ty: Id<TypeSpec>,
    /// Its initial value.
    pub initial: Option<Id<Expr>>,
    /// All of it.
    pub range: TextRange,
}
