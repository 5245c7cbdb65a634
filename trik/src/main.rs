//! The program `trik`; started under the name `trikfs`, `trikfs-ev3dev` or `trikd` it is that program, so that one file
//! serves a whole robot; as `trik-sandbox` it confines a
//! solution that is judged; under `2D-model` or `patcher` it stands in for these programs of TRIK Studio.

use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    let name = std::env::args_os().next().unwrap_or_default();
    match Path::new(&name).file_name().and_then(|name| name.to_str()) {
        Some("trikfs") => trikfs::cli::main(),
        Some("trikd") => trikd::cli::main(),
        Some("trikfs-ev3dev") => trikfs_ev3dev::cli::main(),
        Some(trik::sandbox::NAME) => trik::sandbox::main(),
        Some(name) if trik::cli::is_of_studio(name) => trik::cli::of_studio(name),
        _ => trik::cli::main(),
    }
}
