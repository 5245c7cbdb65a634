//! `trikfs check` and `trikfs convert`: a configuration tried without a mount.
//!
//! Owns the reading of configuration files. Makes the same checks as the live node and opens no device.

use crate::convert::shared::Cache;
use crate::convert::{Recipe, Workshop, lua::StateMaker};
use crate::reload;
use config::limits::CONFIG_BYTES_MAX;
use config::load::{Loaded, Loader};
use config::problem::Problem;
use config::program::Direction;
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Where a configuration finds what it names.
pub struct SearchPaths {
    /// Where `include` looks.
    pub include_dirs: Vec<PathBuf>,
    /// Where shared libraries are looked for after the configuration's directory.
    pub library_dirs: Vec<PathBuf>,
    /// Below which all device paths are taken.
    pub device_root: Option<PathBuf>,
    /// Compiled converters.
    pub cache: Cache,
}

/// Reads a configuration file, no more of it than a configuration may have.
pub fn read_config(file: &Path) -> Result<Vec<u8>, String> {
    let failed = |error: std::io::Error| format!("{}: {error}", file.display());
    let opened = std::fs::File::open(file).map_err(failed)?;
    let mut bytes = Vec::new();
    opened
        .take(CONFIG_BYTES_MAX as u64 + 1)
        .read_to_end(&mut bytes)
        .map_err(failed)?;
    Ok(bytes)
}

fn load(file: &Path, paths: &SearchPaths) -> Result<Loaded, Problem> {
    let name = file.display().to_string();
    let bytes = read_config(file).map_err(|reason| {
        let reason = reason
            .strip_prefix(&format!("{name}: "))
            .unwrap_or(&reason)
            .to_owned();
        Problem::new(name.clone(), 0, reason)
    })?;
    let loader = Loader {
        include_dirs: paths.include_dirs.clone(),
        library_dirs: paths.library_dirs.clone(),
        device_root: paths.device_root.clone(),
    };
    loader.load(&name, file.parent(), &bytes)
}

/// Makes all the checks that bringing the file into force would make. Returns the warnings.
pub fn check(
    file: &Path,
    paths: &SearchPaths,
    progress: &dyn Fn(&str),
) -> Result<Vec<Problem>, Problem> {
    let loaded = load(file, paths)?;
    let workshop = Workshop {
        cache: &paths.cache,
        progress,
    };
    for description in reload::all(&loaded.config) {
        Recipe::prepare(description, &workshop, None)?;
    }
    let mut warnings = loaded.warnings;
    warnings.extend(reload::missing_devices(&loaded.config));
    Ok(warnings)
}

/// Runs one node's converter over a stream of bytes. A rest shorter than a tuple is an error at the end.
pub fn convert(
    file: &Path,
    node: &str,
    paths: &SearchPaths,
    input: &mut dyn Read,
    output: &mut dyn Write,
) -> Result<(), String> {
    let loaded = load(file, paths).map_err(|problem| problem.to_string())?;
    let Some(description) =
        reload::all(&loaded.config).find(|description| description.path == node)
    else {
        let known: Vec<_> = reload::all(&loaded.config)
            .map(|description| description.path.as_str())
            .collect();
        return Err(format!(
            "{}: there is no node {node}; there are: {}",
            file.display(),
            known.join(", ")
        ));
    };
    let workshop = Workshop {
        cache: &paths.cache,
        progress: &|_| {},
    };
    let maker = StateMaker::start().map_err(|error| error.to_string())?;
    let pool = description
        .uses_lua()
        .then(|| maker.pool(loaded.program.clone()));
    let recipe =
        Recipe::prepare(description, &workshop, pool).map_err(|problem| problem.to_string())?;
    let mut pipeline = recipe
        .open(&(Arc::new(|text: &str| eprintln!("{text}")) as _))
        .map_err(|error| error.to_string())?;

    let (in_size, out_size) = (description.input_tuple_size, description.output_tuple_size);
    let tuples = (64 << 10) / in_size.max(out_size).max(1);
    let mut raw = vec![0; in_size * tuples.max(1)];
    let mut converted = vec![0; out_size * tuples.max(1)];
    let mut done = 0usize;
    loop {
        let filled = fill(input, &mut raw).map_err(|error| format!("standard input: {error}"))?;
        let whole = filled / in_size;
        let batch = pipeline.convert(Direction::Read, &raw[..whole * in_size], &mut converted);
        let produced = if batch.produced == usize::MAX {
            whole
        } else {
            batch.produced
        };
        let written = output
            .write_all(&converted[..produced * out_size])
            .and_then(|()| output.flush());
        match written {
            Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => return Ok(()),
            other => other.map_err(|error| format!("standard output: {error}"))?,
        }
        if let Some(error) = batch.fault {
            return Err(format!(
                "node {node}: tuple {}: {error}",
                done + batch.consumed
            ));
        }
        done += whole;
        let rest = filled - whole * in_size;
        if filled < raw.len() {
            if rest > 0 {
                return Err(format!(
                    "node {node}: the input ends {rest} bytes into a tuple of {in_size}"
                ));
            }
            return Ok(());
        }
    }
}

fn fill(input: &mut dyn Read, buf: &mut [u8]) -> std::io::Result<usize> {
    let mut filled = 0;
    while filled < buf.len() {
        match input.read(&mut buf[filled..]) {
            Ok(0) => break,
            Ok(n) => filled += n,
            Err(error) if error.kind() == std::io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
    Ok(filled)
}
