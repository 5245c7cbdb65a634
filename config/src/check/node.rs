//! One description, field by field: sizes, pace, permissions, rest, limits.

use super::fields::NodeFields;
use super::stages::{StageDraft, sized};
use crate::description::{
    NodeDescription, Pace, RegulatorDescription, SourceDescription, StageDescription,
};
use crate::format::Format;
use crate::limits::{
    ABOUT_BYTES_MAX, BUDGET_US, BUDGET_US_MAX, MEMORY_KB, MEMORY_KB_MAX, MEMORY_KB_MIN,
    NAME_BYTES_MAX, PERIOD_MS_MAX, TIMEOUT_MS, TUPLE_BYTES_MAX, UNITS_BYTES_MAX,
};
use crate::problem::Problem;
use crate::value::Value;
use crate::vm::fingerprint::hash;
use nix::unistd::{Group, User};

/// All fields of a description.
pub(super) const FIELDS: [&str; 29] = [
    "about",
    "ages",
    "always",
    "attributes",
    "budget_us",
    "converter",
    "format",
    "group",
    "input_format",
    "input_tuple_size",
    "interval",
    "isolate",
    "max_age_ms",
    "memory_kb",
    "mode",
    "on_event",
    "output_tuple_size",
    "owner",
    "params",
    "poll_ms",
    "raw",
    "read_back",
    "rest",
    "share",
    "src",
    "timeout_ms",
    "trigger",
    "units",
    "write_converter",
];

/// Sizes and what depends on them.
struct Layout {
    input: usize,
    output: usize,
    format: Option<Format>,
}

impl NodeFields<'_, '_> {
    /// Reads and checks everything.
    pub(super) fn description(&mut self) -> Result<NodeDescription, Problem> {
        self.only("", self.table, &FIELDS)?;
        let (source, input) = self.source()?;
        let read = self.stages("converter")?.unwrap_or_default();
        let write = self.stages("write_converter")?;
        let mut layout = self.layout(input, &read)?;
        self.check_input_format(&source, layout.input)?;
        if layout.format.is_none() && read.is_empty() {
            layout.format = self.joined_format(&source);
        }
        let read_only = match source.linked_node() {
            // Writing through another node has to be asked for.
            Some(other) => write.is_none() || !self.checker.takes_tuples(other),
            None => !source.takes_writes(),
        };
        if write.is_some() && read_only {
            return Err(self.problem(
                "write_converter",
                "write_converter makes no sense: the source cannot be written",
            ));
        }
        let usual_mode = usual_mode(&source, read_only);
        let digests: Vec<u128> = read
            .iter()
            .chain(write.iter().flatten())
            .map(|stage| stage.digest)
            .collect();
        let (input_size, output_size) = (layout.input, layout.output);
        let converter = sized(read, input_size, output_size)
            .map_err(|error| self.problem("converter", error.to_string()))?;
        let write_converter = self.write_stages(write, &source, &layout)?;
        let (params, param_ranges) = self.params()?;
        let mut node = NodeDescription {
            path: self.path.clone(),
            place: self.own_place(),
            source,
            input_tuple_size: input_size,
            output_tuple_size: output_size,
            converter,
            write_converter,
            format: layout.format,
            about: self.words("about", ABOUT_BYTES_MAX)?,
            units: self.words("units", UNITS_BYTES_MAX)?,
            pace: self.pace()?,
            max_age_ms: self.max_age_ms()?,
            mode: self.mode()?.unwrap_or(usual_mode),
            owner: self.owner()?,
            group: self.owning_group()?,
            rest: self.rest()?,
            read_back: self.boolean("read_back")?.unwrap_or(false),
            timeout_ms: self
                .whole("timeout_ms", 1, PERIOD_MS_MAX)?
                .unwrap_or(TIMEOUT_MS),
            budget_us: self
                .whole("budget_us", 1, BUDGET_US_MAX)?
                .unwrap_or(BUDGET_US),
            memory_kb: self
                .whole("memory_kb", MEMORY_KB_MIN, MEMORY_KB_MAX)?
                .unwrap_or(MEMORY_KB),
            params,
            param_ranges,
            attributes: Vec::new(),
            share: self.boolean("share")?,
            isolate: self.boolean("isolate")?.unwrap_or(false),
            raw: self.boolean("raw")?.unwrap_or(false),
            fingerprint: 0,
        };
        self.check_regulator(&mut node)?;
        self.check_rest(&node, read_only)?;
        self.check_flags(&node, read_only)?;
        node.fingerprint = fingerprint(&node, &digests);
        Ok(node)
    }

    /// A text that may be left out.
    fn words(&self, field: &str, bytes_max: usize) -> Result<String, Problem> {
        Ok(self.text(field, bytes_max)?.unwrap_or_default().to_owned())
    }

    /// The stages from program to device; for a regulator, those of its control law.
    fn write_stages(
        &self,
        write: Option<Vec<StageDraft>>,
        source: &SourceDescription,
        layout: &Layout,
    ) -> Result<Option<Vec<StageDescription>>, Problem> {
        let Some(drafts) = write else {
            return Ok(None);
        };
        let (before, after) = match source.law_output_size() {
            Some(driven) => (RegulatorDescription::law_input_size(layout.output), driven),
            None => (layout.output, layout.input),
        };
        let stages = sized(drafts, before, after);
        stages
            .map(Some)
            .map_err(|error| self.problem("write_converter", error.to_string()))
    }

    fn own_place(&self) -> crate::description::Place {
        let keys: Vec<&str> = self.keys.iter().map(String::as_str).collect();
        self.texts.place(&keys)
    }

    /// Finds out both sizes.
    fn layout(&self, input: Option<usize>, read: &[StageDraft]) -> Result<Layout, Problem> {
        let format = match self.text("format", 64 << 10)? {
            None => None,
            Some(text) => Some(
                Format::parse(text).map_err(|error| self.problem("format", error.to_string()))?,
            ),
        };
        let format_size = format.as_ref().map(Format::size);
        let given = match self.get("output_tuple_size") {
            None => None,
            Some(value) => Some(self.tuple_size("output_tuple_size", value)?),
        };
        if let (Some(size), Some(given)) = (format_size, given)
            && size != given
        {
            let reason = format!("format has {size} bytes, but output_tuple_size is {given}");
            return Err(self.problem("format", reason));
        }
        let said = read.last().and_then(|stage| stage.output_size);
        let output = given.or(format_size).or(said);
        if let Some(size) = output.filter(|size| *size > TUPLE_BYTES_MAX) {
            return Err(self.problem(
                "format",
                format!("the tuple has {size} bytes, more than {TUPLE_BYTES_MAX}"),
            ));
        }
        let (input, output) = match (input, output) {
            (Some(input), Some(output)) => (input, output),
            (Some(size), None) | (None, Some(size)) if read.is_empty() => (size, size),
            (None, _) => {
                return Err(self.problem("input_tuple_size", "input_tuple_size is missing"));
            }
            (Some(_), None) => {
                return Err(self.problem(
                    "output_tuple_size",
                    "output_tuple_size is missing; a format gives it as well",
                ));
            }
        };
        if read.is_empty() && input != output {
            let field = if given.is_some() {
                "output_tuple_size"
            } else {
                "format"
            };
            let reason = format!(
                "without a converter the tuples before and after have the same size, not {input} and {output} bytes"
            );
            return Err(self.problem(field, reason));
        }
        Ok(Layout {
            input,
            output,
            format,
        })
    }

    fn pace(&self) -> Result<Pace, Problem> {
        let period = self.whole("poll_ms", 1, PERIOD_MS_MAX)?;
        let on_event = self.boolean("on_event")?.unwrap_or(false);
        let always = self.boolean("always")?;
        if always.is_some() && period.is_none() {
            let reason =
                "always goes with poll_ms: it says whether the clock samples while nobody needs it";
            return Err(self.problem("always", reason));
        }
        match (period, on_event) {
            (Some(_), true) => {
                Err(self.problem("on_event", "poll_ms and on_event exclude each other"))
            }
            (Some(period_ms), false) => Ok(Pace::Every {
                period_ms,
                always: always.unwrap_or(false),
            }),
            (None, true) => Ok(Pace::OnEvent),
            (None, false) => Ok(Pace::OnRead),
        }
    }

    fn max_age_ms(&self) -> Result<Option<u32>, Problem> {
        let age = self.whole("max_age_ms", 1, PERIOD_MS_MAX)?;
        if age.is_some() && self.pace()? == Pace::OnRead {
            let reason = "max_age_ms goes with poll_ms or on_event: without them each read takes a new sample";
            return Err(self.problem("max_age_ms", reason));
        }
        Ok(age)
    }

    /// Permission bits: `'0644'`, or a number whose decimal digits are the octal ones, because `0644` is 644 in Lua.
    fn mode(&self) -> Result<Option<u16>, Problem> {
        let digits = match self.get("mode") {
            None => return Ok(None),
            Some(Value::Text(text)) => String::from_utf8_lossy(text).into_owned(),
            Some(Value::Number(number)) => number.to_string(),
            Some(value) => return Err(self.wrong_type("mode", "permissions like '0644'", value)),
        };
        let shown: String = digits
            .chars()
            .take(16)
            .flat_map(char::escape_debug)
            .collect();
        let plain = !digits.is_empty()
            && digits.len() <= 8
            && digits.bytes().all(|byte| (b'0'..=b'7').contains(&byte));
        let bits = u32::from_str_radix(&digits, 8).ok().filter(|_| plain);
        match bits {
            None => Err(self.problem(
                "mode",
                format!("mode must be octal digits like '0644', not '{shown}'"),
            )),
            Some(bits) if bits > 0o777 => {
                Err(self.problem("mode", format!("mode '{shown}' is beyond 0777")))
            }
            Some(bits) => Ok(u16::try_from(bits).ok()),
        }
    }

    fn owner(&self) -> Result<Option<u32>, Problem> {
        self.account("owner", "user", |name| {
            User::from_name(name)
                .ok()
                .flatten()
                .map(|user| user.uid.as_raw())
        })
    }

    fn owning_group(&self) -> Result<Option<u32>, Problem> {
        self.account("group", "group", |name| {
            Group::from_name(name)
                .ok()
                .flatten()
                .map(|group| group.gid.as_raw())
        })
    }

    /// A name or number of a user or group.
    fn account(
        &self,
        field: &str,
        what: &str,
        find: impl Fn(&str) -> Option<u32>,
    ) -> Result<Option<u32>, Problem> {
        match self.get(field) {
            None => Ok(None),
            // The largest number means "nobody in particular" to chown and is no account.
            Some(value @ Value::Number(_)) => {
                self.whole_value(field, value, 0, u32::MAX - 1).map(Some)
            }
            Some(_) => {
                let name = self.text(field, NAME_BYTES_MAX)?.unwrap_or_default();
                let id = find(name)
                    .ok_or_else(|| self.problem(field, format!("there is no {what} '{name}'")))?;
                Ok(Some(id))
            }
        }
    }

    /// One number or a list of numbers.
    fn rest(&self) -> Result<Option<Vec<f64>>, Problem> {
        let Some(value) = self.get("rest") else {
            return Ok(None);
        };
        let Some(table) = self.table_of(value) else {
            return Ok(Some(vec![self.finite_value("rest", value)?]));
        };
        let list = table.list();
        if list.is_empty() || list.len() != table.entries.len() {
            return Err(self.problem("rest", "rest must be a number or a list of numbers"));
        }
        list.into_iter()
            .map(|value| self.finite_value("rest", value))
            .collect::<Result<_, _>>()
            .map(Some)
    }

    /// What is written can be compared with what is read: the source keeps it, and the sizes are the same.
    fn check_read_back(&self, node: &NodeDescription, read_only: bool) -> Result<(), Problem> {
        let keeps = node.source.keeps_what_is_written() && !read_only;
        if node.read_back && !(keeps && node.write_converter.is_some()) {
            let reason = "read_back is for devices that keep what is written, with a converter and a write_converter";
            return Err(self.problem("read_back", reason));
        }
        Ok(())
    }

    /// There is machine code that a process of its own can hold.
    fn check_isolate(&self, node: &NodeDescription) -> Result<(), Problem> {
        if node.isolate && !node.uses_machine_code() {
            let reason = "isolate is for shared libraries and inline C, and this node has neither; a converter in Lua needs no process of its own";
            return Err(self.problem("isolate", reason));
        }
        Ok(())
    }

    /// Those that say yes or no fit the rest.
    fn check_flags(&self, node: &NodeDescription, read_only: bool) -> Result<(), Problem> {
        self.check_read_back(node, read_only)?;
        self.check_isolate(node)?;
        self.check_raw(node)
    }

    /// There is somebody who takes samples in the background and publishes them.
    fn check_raw(&self, node: &NodeDescription) -> Result<(), Problem> {
        if node.raw && node.pace == Pace::OnRead {
            let reason = "raw needs samples in the background: give the node poll_ms or on_event";
            return Err(self.problem("raw", reason));
        }
        Ok(())
    }

    /// The rest value can be written: the source takes writes, and the numbers fit the tuple that a program writes.
    fn check_rest(&self, node: &NodeDescription, read_only: bool) -> Result<(), Problem> {
        let Some(rest) = &node.rest else {
            return Ok(());
        };
        if read_only {
            return Err(self.problem("rest", "rest makes no sense: the source cannot be written"));
        }
        let size = node.written_tuple_size();
        let format = node
            .format
            .clone()
            .filter(|format| format.size() == size)
            .unwrap_or_else(|| Format::bytes(size));
        let encoded = format.encode_numbers(rest, &mut vec![0; size]);
        encoded.map_err(|error| self.problem("rest", format!("rest: {error}")))
    }
}

/// Digest of everything that makes the node behave as it does; not of where it stands in the text.
fn fingerprint(node: &NodeDescription, digests: &[u128]) -> u128 {
    fn plain(stages: &[StageDescription]) -> Vec<String> {
        stages
            .iter()
            .map(|stage| {
                format!(
                    "{:?} {} {}",
                    stage.kind, stage.input_size, stage.output_size
                )
            })
            .collect()
    }
    let source: &SourceDescription = &node.source;
    let stages = (
        plain(&node.converter),
        node.write_converter.as_deref().map(plain),
        digests,
    );
    let sizes = (
        node.input_tuple_size,
        node.output_tuple_size,
        &node.format,
        &node.units,
    );
    let access = (
        (node.pace, node.max_age_ms),
        node.mode,
        node.owner,
        node.group,
        &node.rest,
        node.share,
        node.read_back,
        node.isolate,
        node.raw,
    );
    let limits = (
        node.timeout_ms,
        node.budget_us,
        node.memory_kb,
        &node.params,
        &node.param_ranges,
    );
    hash(format!("{:?}", (&node.path, source, stages, sizes, access, limits)).as_bytes())
}

/// The permission bits of a node that asks for none.
fn usual_mode(source: &SourceDescription, read_only: bool) -> u16 {
    match (source.gives_tuples(), read_only) {
        (false, _) => 0o222,
        (true, true) => 0o444,
        (true, false) => 0o644,
    }
}
