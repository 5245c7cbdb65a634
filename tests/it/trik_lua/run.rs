//! A robot file that is loaded as the program loads it, and its converters, called with bytes.
//!
//! Owns the state of the converters, which lasts as long as the value. Opens no device and mounts nothing.

use config::description::{NodeDescription, StageDescription, StageKind};
use config::load::{Loaded, Loader};
use config::program::{StageId, Vm};
use converter::{Conversion, Direction};
use std::collections::HashMap;
use std::path::Path;

/// A loaded robot.
pub struct Robot {
    pub loaded: Loaded,
    vm: Vm,
    bound: HashMap<(String, bool), Vec<StageId>>,
}

/// Loads a text as a robot file.
pub fn load(text: &str) -> Result<Loaded, String> {
    let lua = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../config/lua"));
    let loader = Loader {
        include_dirs: vec![lua.to_owned()],
        ..Loader::default()
    };
    let loaded = loader.load("robot.lua", None, text.as_bytes());
    loaded.map_err(|problem| problem.to_string())
}

/// A robot with these entries in its list.
pub fn robot(entries: &str) -> Robot {
    Robot::new(&format!(
        "local trik = include 'trik.lua'\ntrikfs = trik.robot {{ {entries} }}"
    ))
}

/// The reason why a list of entries is refused.
pub fn refused(entries: &str) -> String {
    let text = format!("local trik = include 'trik.lua'\n\ntrikfs = trik.robot {{ {entries} }}");
    match load(&text) {
        Ok(_) => format!("accepted: {entries}"),
        Err(problem) => problem,
    }
}

impl Robot {
    pub fn new(text: &str) -> Self {
        let loaded = load(text).unwrap_or_else(|problem| panic!("{problem}"));
        assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
        let mut vm = loaded.program.run_anew().unwrap();
        // One state for all nodes, and on a busy machine: neither limit is what is tested here.
        vm.limit(16 << 10, 5_000_000);
        Self {
            loaded,
            vm,
            bound: HashMap::new(),
        }
    }

    /// A description by its path.
    pub fn node(&self, path: &str) -> &NodeDescription {
        let nodes = self.loaded.config.nodes.iter();
        let mut all = nodes.flat_map(|node| std::iter::once(node).chain(&node.attributes));
        all.find(|node| node.path == path)
            .unwrap_or_else(|| panic!("there is no node {path}"))
    }

    /// Converts one tuple; None if it was taken and nothing came of it.
    fn convert(
        &mut self,
        path: &str,
        writes: bool,
        input: &[u8],
    ) -> Result<Option<Vec<u8>>, String> {
        let node = self.node(path);
        let written = node.write_converter.clone();
        let stages: Vec<StageDescription> = match (writes, written) {
            (true, Some(stages)) => stages,
            _ => node.converter.clone(),
        };
        let takes = if writes {
            node.write_conversion_sizes().0
        } else {
            node.input_tuple_size
        };
        assert_eq!(input.len(), takes, "{path}: bytes of one tuple");
        let direction = if writes {
            Direction::Write
        } else {
            Direction::Read
        };
        let vm = &mut self.vm;
        let ids = self
            .bound
            .entry((path.to_owned(), writes))
            .or_insert_with(|| {
                let bind = |(position, stage): (usize, &StageDescription)| {
                    assert_eq!(stage.kind, StageKind::Lua, "{path}");
                    let (input, output) = (stage.input_size, stage.output_size);
                    vm.bind(path, direction, position, input, output).unwrap()
                };
                stages.iter().enumerate().map(bind).collect()
            });
        let mut tuple = input.to_vec();
        for (id, stage) in ids.iter().zip(&stages) {
            let mut output = vec![0; stage.output_size];
            let done = self.vm.convert(*id, &tuple, &mut output);
            match done.map_err(|fault| fault.to_string())? {
                Conversion::Produced => tuple = output,
                Conversion::Consumed => return Ok(None),
            }
        }
        Ok(Some(tuple))
    }

    /// From device to program: the numbers as `value` shows them.
    pub fn read(&mut self, path: &str, input: &[u8]) -> Result<String, String> {
        let tuple = self.convert(path, false, input)?;
        let Some(tuple) = tuple else {
            return Ok("nothing".to_owned());
        };
        let format = self.node(path).format.as_ref();
        let mut text = String::new();
        format
            .unwrap_or_else(|| panic!("{path} has no format"))
            .render(&tuple, &mut text)
            .unwrap();
        Ok(text.trim_end().to_owned())
    }

    /// One step of a regulator: the bytes for what is driven.
    pub fn step(
        &mut self,
        path: &str,
        ordered: i32,
        measured: i32,
        interval_us: u32,
    ) -> Result<Vec<u8>, String> {
        let mut tuple = ordered.to_le_bytes().to_vec();
        tuple.extend(measured.to_le_bytes());
        tuple.extend(interval_us.to_le_bytes());
        let driven = self.convert(path, true, &tuple)?;
        Ok(driven.expect("a law that gives something"))
    }

    /// From program to device: the bytes of a text.
    pub fn write_text(&mut self, path: &str, text: &str) -> Result<Vec<u8>, String> {
        let mut tuple = text.as_bytes().to_vec();
        tuple.resize(self.node(path).written_tuple_size(), 0);
        let written = self.convert(path, true, &tuple)?;
        Ok(written.expect("a written tuple goes on"))
    }

    /// From program to device: the bytes of these numbers.
    pub fn write(&mut self, path: &str, numbers: &[f64]) -> Result<Vec<u8>, String> {
        let node = self.node(path);
        let mut tuple = vec![0; node.written_tuple_size()];
        let format = node.format.as_ref();
        let format = format.unwrap_or_else(|| panic!("{path} has no format"));
        format.encode_numbers(numbers, &mut tuple).unwrap();
        let written = self.convert(path, true, &tuple)?;
        Ok(written.expect("a written tuple goes on"))
    }
}
