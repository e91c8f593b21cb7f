//! The head of a file test. Whatever begins like a directive must be one, so that a slip of the
//! pen cannot silence a test.

use iecc_ir::FaultCode;

/// What is done with the module.
#[derive(Debug)]
pub(super) enum Command {
    /// Verify and expect these errors.
    Verify(Vec<ExpectedError>),
    /// Run scans.
    Run(RunTest),
    /// Run passes, and scans if asked to.
    Pass(Vec<String>, Option<RunTest>),
}

/// An error of the verifier.
#[derive(Debug)]
pub(super) struct ExpectedError {
    pub(super) rule: u8,
    /// Part of the message.
    pub(super) message: String,
}

/// Scans with what goes in and comes out.
#[derive(Debug, Default)]
pub(super) struct RunTest {
    /// The time of each scan.
    pub(super) times_ns: Vec<u64>,
    pub(super) fuel: Option<u64>,
    pub(super) prescan: bool,
    pub(super) inputs: Vec<Column>,
    pub(super) outputs: Vec<Column>,
    pub(super) states: Vec<Column>,
    pub(super) faults: Option<Vec<Option<ExpectedFault>>>,
}

/// A name and its value in each scan, as text.
#[derive(Debug)]
pub(super) struct Column {
    pub(super) name: String,
    pub(super) values: Vec<String>,
}

/// A fault, and its origin if the test names one.
#[derive(Debug, Clone, Copy)]
pub(super) struct ExpectedFault {
    pub(super) code: FaultCode,
    pub(super) origin: Option<u32>,
}

/// Directives as they are read.
#[derive(Debug, Default)]
struct Reader {
    run: RunTest,
    has_run: bool,
    verify: Option<Vec<ExpectedError>>,
    pass: Option<Vec<String>>,
}

/// Reads the directives above the module.
pub(super) fn parse(text: &str) -> Result<Command, String> {
    let mut reader = Reader::default();
    let head = text.lines().map(str::trim);
    for line in head.take_while(|line| line.is_empty() || line.starts_with(';')) {
        if !line.is_empty() && !line.starts_with(";;") && !line.starts_with(";>") {
            reader.directive(line[1..].trim())?;
        }
    }
    reader.finish()
}

impl Reader {
    fn directive(&mut self, line: &str) -> Result<(), String> {
        let (key, rest) = line
            .split_once(": ")
            .or_else(|| line.strip_suffix(':').map(|key| (key, "")))
            .ok_or_else(|| format!("{line:?} is no directive; explanations begin with ;;"))?;
        let words = || {
            rest.split_whitespace()
                .map(str::to_owned)
                .collect::<Vec<_>>()
        };
        let column = |name: &str| Column {
            name: name.to_owned(),
            values: words(),
        };
        match key.split_once(' ').unwrap_or((key, "")) {
            ("run", "") => return self.run(rest),
            ("at", "") => {
                let times = rest.split_whitespace().map(duration_ns);
                self.run.times_ns = times.collect::<Result<_, _>>()?;
                self.has_run = true;
            }
            ("in", name) => self.run.inputs.push(column(name)),
            ("out", name) => self.run.outputs.push(column(name)),
            ("state", name) => self.run.states.push(column(name)),
            ("fault", "") => {
                let faults = rest.split_whitespace().map(fault);
                self.run.faults = Some(faults.collect::<Result<_, _>>()?);
            }
            ("verify", "") => self
                .verify
                .get_or_insert_default()
                .extend(expected_error(rest)?),
            ("pass", "") => self.pass = Some(words()),
            _ => return Err(format!("unknown directive {key:?}")),
        }
        Ok(())
    }

    fn run(&mut self, settings: &str) -> Result<(), String> {
        let (mut scans, mut period_ns) = (0, 0);
        for setting in settings.split_whitespace() {
            let number = |text: &str| {
                text.parse::<u64>()
                    .map_err(|_| format!("{text:?} is no number"))
            };
            match setting.split_once('=').unwrap_or((setting, "")) {
                ("scans", count) => scans = number(count)?,
                ("period", period) => period_ns = duration_ns(period)?,
                ("fuel", fuel) => self.run.fuel = Some(number(fuel)?),
                ("prescan", "") => self.run.prescan = true,
                _ => return Err(format!("unknown setting {setting:?}")),
            }
        }
        if scans > 0 {
            self.run.times_ns = (0..scans).map(|scan| scan * period_ns).collect();
        }
        self.has_run = true;
        Ok(())
    }

    fn finish(self) -> Result<Command, String> {
        let run = self.run;
        let expects = run.outputs.len() + run.states.len() + usize::from(run.faults.is_some());
        let columns = expects + run.inputs.len();
        if self.has_run && (expects == 0 || run.times_ns.is_empty()) {
            return Err("the run expects nothing".to_owned());
        }
        if !self.has_run && columns > 0 {
            let what = if self.verify.is_some() {
                "verify takes no"
            } else {
                "no run for the"
            };
            return Err(format!("{what} inputs and results"));
        }
        match (self.verify, self.pass, self.has_run) {
            (Some(expected), None, false) => Ok(Command::Verify(expected)),
            (None, Some(names), has_run) => Ok(Command::Pass(names, has_run.then_some(run))),
            (None, None, true) => Ok(Command::Run(run)),
            (None, None, false) => Err("neither run, verify nor pass is asked for".to_owned()),
            (Some(_), _, _) => Err("only one of run, verify and pass can be done".to_owned()),
        }
    }
}

/// `ok` is no error.
fn expected_error(text: &str) -> Result<Option<ExpectedError>, String> {
    if text == "ok" {
        return Ok(None);
    }
    let error = text.strip_prefix("error ").and_then(|rest| {
        let (rule, message) = rest.split_once(' ').unwrap_or((rest, ""));
        let (rule, message) = (rule.parse().ok()?, message.to_owned());
        Some(ExpectedError { rule, message })
    });
    error
        .map(Some)
        .ok_or_else(|| format!("{text:?} is neither ok nor error RULE"))
}

fn fault(text: &str) -> Result<Option<ExpectedFault>, String> {
    if text == "-" {
        return Ok(None);
    }
    let (name, origin) = match text.split_once('@') {
        None => (text, None),
        Some((name, origin)) => (name, Some(origin.parse().map_err(|_| format!("{text:?}"))?)),
    };
    let code = FaultCode::parse(name).ok_or_else(|| format!("{name:?} is no fault"))?;
    Ok(Some(ExpectedFault { code, origin }))
}

fn duration_ns(text: &str) -> Result<u64, String> {
    let units = [
        ("ns", 1),
        ("us", 1_000),
        ("ms", 1_000_000),
        ("s", 1_000_000_000),
    ];
    let found = units.iter().find_map(|(unit, ns)| {
        let number: u64 = text.strip_suffix(unit)?.parse().ok()?;
        number.checked_mul(*ns)
    });
    found.ok_or_else(|| format!("{text:?} is no duration"))
}
