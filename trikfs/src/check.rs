//! `trikfs check`: a configuration tried without a mount.
//!
//! Owns the reading of configuration files. Makes the same checks as the live node and opens no device.

use crate::convert::shared::Cache;
use crate::convert::{Recipe, Workshop};
use crate::reload;
use config::limits::CONFIG_BYTES_MAX;
use config::load::{Loaded, Loader};
use config::problem::Problem;
use std::io::Read;
use std::path::{Path, PathBuf};

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

/// Loads a configuration file; libraries are not touched yet.
pub(crate) fn load(file: &Path, paths: &SearchPaths) -> Result<Loaded, Problem> {
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
