//! The global `setup`: actions that are done once when a configuration comes into force.
//!
//! Owns their keys and limits. Does none of them.

use super::Checker;
use super::fields::NodeFields;
use crate::description::{SetupAction, SetupStep};
use crate::limits::{SETUP_ACTIONS_MAX, SETUP_BYTES_MAX, SETUP_TIMEOUT_MS, SETUP_TIMEOUT_MS_MAX};
use crate::problem::Problem;
use crate::value::{Table, Value};

/// Keys of an action.
const KEYS: [&str; 6] = ["path", "run", "timeout_ms", "to", "unless", "write"];

impl<'a> Checker<'a> {
    /// Reads the list of actions; nothing if the program left none.
    pub(super) fn setup(&mut self) -> Result<Vec<SetupAction>, Problem> {
        let Some(value) = &self.values.setup else {
            return Ok(Vec::new());
        };
        let keys = vec!["setup".to_owned()];
        let Some(table) = self.values.table(value) else {
            let reason = format!(
                "'setup' must be a list of actions, not {}",
                value.describe()
            );
            return Err(self.problem(&keys, reason));
        };
        let list = table.list();
        if list.len() != table.entries.len() {
            let reason = "'setup' must be a list of actions: { { path = ..., write = ... }, ... }";
            return Err(self.problem(&keys, reason.into()));
        }
        if list.len() > SETUP_ACTIONS_MAX {
            let reason = format!("'setup' has more than {SETUP_ACTIONS_MAX} actions");
            return Err(self.problem(&keys, reason));
        }
        let mut actions = Vec::new();
        for (index, value) in list.into_iter().enumerate() {
            let path = format!("setup[{}]", index + 1);
            let Some(table) = self.values.table(value) else {
                let reason = format!("{path}: an action is a table, not {}", value.describe());
                return Err(self.problem(&keys, reason));
            };
            let mut fields = NodeFields::new(self, path, keys.clone(), table, 0);
            actions.push(fields.setup_action(table)?);
        }
        Ok(actions)
    }
}

impl<'a> NodeFields<'_, 'a> {
    fn setup_action(&mut self, table: &'a Table) -> Result<SetupAction, Problem> {
        self.only("", table, &KEYS)?;
        let given: Vec<&str> = ["path", "run", "to"]
            .into_iter()
            .filter(|key| table.get(key).is_some())
            .collect();
        let [kind] = given.as_slice() else {
            return Err(self.problem(
                "",
                "an action has exactly one of path (with write), run, and to (with write)",
            ));
        };
        let step = match *kind {
            "path" => SetupStep::Write {
                path: self.setup_path("path")?,
                bytes: self.setup_bytes()?,
            },
            "run" => self.setup_program(table)?,
            _ => self.setup_send(table)?,
        };
        let unless = match self.get("unless") {
            None => None,
            Some(_) => Some(self.setup_path("unless")?),
        };
        Ok(SetupAction {
            place: self.place(""),
            step,
            unless,
            timeout_ms: self
                .whole("timeout_ms", 1, SETUP_TIMEOUT_MS_MAX)?
                .unwrap_or(SETUP_TIMEOUT_MS),
        })
    }

    fn setup_path(&self, field: &str) -> Result<std::path::PathBuf, Problem> {
        match self.get(field) {
            Some(value) => self.absolute(field, value),
            None => Err(self.problem(field, format!("{field} is missing"))),
        }
    }

    fn setup_bytes(&self) -> Result<Vec<u8>, Problem> {
        match self.get("write") {
            Some(Value::Text(bytes)) if bytes.is_empty() => {
                Err(self.problem("write", "write is empty"))
            }
            Some(Value::Text(bytes)) if bytes.len() > SETUP_BYTES_MAX => Err(self.problem(
                "write",
                format!("write has more than {SETUP_BYTES_MAX} bytes"),
            )),
            Some(Value::Text(bytes)) => Ok(bytes.clone()),
            Some(value) => Err(self.wrong_type("write", "a string", value)),
            None => Err(self.problem("write", "write is missing")),
        }
    }

    fn setup_program(&self, table: &'a Table) -> Result<SetupStep, Problem> {
        if table.get("write").is_some() {
            return Err(self.problem("write", "write makes no sense with run"));
        }
        let wrong = || self.problem("run", "run is a list: the program, then its arguments");
        let list = self.get("run").and_then(|value| self.table_of(value));
        let list = list.ok_or_else(wrong)?;
        let words = list.list();
        if words.is_empty() || words.len() != list.entries.len() {
            return Err(wrong());
        }
        let mut texts = Vec::new();
        for word in &words {
            let Value::Text(bytes) = word else {
                return Err(self.wrong_type("run", "a list of strings", word));
            };
            let text = std::str::from_utf8(bytes).ok();
            let text = text.filter(|text| !text.contains('\0'));
            let reason = "run: a word is not UTF-8 or holds a zero byte";
            texts.push(text.ok_or_else(|| self.problem("run", reason))?.to_owned());
        }
        if texts.iter().map(String::len).sum::<usize>() > SETUP_BYTES_MAX {
            let reason = format!("run: the words have more than {SETUP_BYTES_MAX} bytes");
            return Err(self.problem("run", reason));
        }
        let program = texts.remove(0);
        if !program.starts_with('/') {
            let reason = format!("run: the program '{program}' is not an absolute path");
            return Err(self.problem("run", reason));
        }
        Ok(SetupStep::Run {
            program: program.into(),
            arguments: texts,
        })
    }

    fn setup_send(&mut self, table: &'a Table) -> Result<SetupStep, Problem> {
        let bytes = self.setup_bytes()?;
        let Some(value) = table.get("to") else {
            return Err(self.problem("to", "to is missing"));
        };
        let to = self.single(value)?;
        if !to.takes_writes() {
            return Err(self.problem("to", "to: the source cannot be written"));
        }
        if let Some(size) = self.size_of(&to)?
            && size != bytes.len()
        {
            let reason = format!(
                "write has {} bytes, but the source takes tuples of {size}",
                bytes.len()
            );
            return Err(self.problem("write", reason));
        }
        to.check_tuple_size(bytes.len(), self)?;
        Ok(SetupStep::Send { to, bytes })
    }
}

#[cfg(test)]
mod tests {
    use crate::description::{SetupStep, SourceDescription};
    use crate::load::Loader;

    fn load(setup: &str) -> Result<Vec<super::SetupAction>, String> {
        let text = format!("trikfs = {{}}\nsetup = {setup}");
        let loaded = Loader::default().load("robot.lua", None, text.as_bytes());
        loaded
            .map(|loaded| loaded.config.setup)
            .map_err(|problem| problem.to_string())
    }

    #[test]
    fn actions_keep_their_order_and_have_the_defaults_of_the_manual() {
        let actions = load(
            "{ { path = '/sys/class/gpio/export', write = '94', unless = '/sys/class/gpio/gpio94' },
               { run = { '/sbin/modprobe', 'hcsr04' }, timeout_ms = 5000 },
               { to = i2c{ '/dev/i2c-2', address = 0x48, register = 0x10, transfer = 'word' }, write = '\\0\\16' } }",
        )
        .unwrap();
        assert_eq!(
            actions[0].step,
            SetupStep::Write {
                path: "/sys/class/gpio/export".into(),
                bytes: b"94".to_vec()
            }
        );
        assert_eq!(
            actions[0].unless.as_deref(),
            Some("/sys/class/gpio/gpio94".as_ref())
        );
        assert_eq!(
            actions[1].step,
            SetupStep::Run {
                program: "/sbin/modprobe".into(),
                arguments: vec!["hcsr04".to_owned()]
            }
        );
        let times: Vec<u32> = actions.iter().map(|action| action.timeout_ms).collect();
        assert_eq!(times, [1000, 5000, 1000]);
        assert!(matches!(
            &actions[2].step,
            SetupStep::Send { to: SourceDescription::I2c(_), bytes } if bytes == &[0, 16]
        ));
        assert_eq!(actions[2].place.to_string(), "robot.lua:2");
        assert_eq!(load("nil"), Ok(vec![]));
        assert_eq!(load("{}"), Ok(vec![]));
    }

    #[test]
    fn actions_that_mean_nothing_are_refused() {
        let i2c = "i2c{ '/dev/i2c-2', address = 0x48, register = 0x10, transfer = 'word' }";
        let cases = [
            ("7", "'setup' must be a list of actions, not a number"),
            (
                "{ path = '/x', write = '1' }",
                "'setup' must be a list of actions: { { path = ..., write = ... }, ... }",
            ),
            ("{ 7 }", "setup[1]: an action is a table, not a number"),
            (
                "{ {} }",
                "setup[1]: an action has exactly one of path (with write), run, and to (with write)",
            ),
            (
                "{ { path = '/x', write = '1' }, { path = '/x', run = { '/y' } } }",
                "setup[2]: an action has exactly one of path (with write), run, and to (with write)",
            ),
            (
                "{ { path = '/x', wirte = '1' } }",
                "setup[1]: unknown key 'wirte', did you mean 'write'",
            ),
            ("{ { path = '/x' } }", "setup[1]: write is missing"),
            (
                "{ { path = '/x', write = '' } }",
                "setup[1]: write is empty",
            ),
            (
                "{ { path = '/x', write = 94 } }",
                "setup[1]: write must be a string, not a number",
            ),
            (
                "{ { run = '/bin/true' } }",
                "setup[1]: run is a list: the program, then its arguments",
            ),
            (
                "{ { run = { 'modprobe' } } }",
                "setup[1]: run: the program 'modprobe' is not an absolute path",
            ),
            (
                "{ { run = { '/bin/true' }, timeout_ms = 60001 } }",
                "setup[1]: timeout_ms must be a whole number from 1 to 60000, not 60001",
            ),
            (
                "{ { to = fake{ data = '1' }, write = '1' } }",
                "setup[1]: to: the source cannot be written",
            ),
        ];
        for (setup, reason) in cases {
            assert_eq!(
                load(setup),
                Err(format!("robot.lua:2: {reason}")),
                "{setup}"
            );
        }
        assert_eq!(
            load(&format!("{{ {{ to = {i2c}, write = '1' }} }}")),
            Err(
                "robot.lua:2: setup[1]: write has 1 bytes, but the source takes tuples of 2"
                    .to_owned()
            )
        );
        let relative = load("{ { path = 'x', write = '1' } }").unwrap_err();
        assert!(
            relative.starts_with("robot.lua:2: setup[1]: "),
            "{relative}"
        );
        let many = "{ path = '/x', write = '1' }, ".repeat(257);
        assert_eq!(
            load(&format!("{{ {many} }}")),
            Err("robot.lua:2: 'setup' has more than 256 actions".to_owned())
        );
    }

    #[test]
    fn a_setup_that_holds_itself_is_refused_and_a_node_may_be_called_so() {
        let text = "trikfs = { setup = { src = '/dev/zero', input_tuple_size = 1 } }\nsetup = {}\nsetup[1] = setup";
        let refused = Loader::default().load("robot.lua", None, text.as_bytes());
        let refused = refused.unwrap_err().to_string();
        assert!(
            refused.ends_with("setup/1: the table holds itself"),
            "{refused}"
        );
    }
}
