//! The program `trik`; started under the name `trikfs` it is that program, so that one file serves a whole robot.

use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    let name = std::env::args_os().next().unwrap_or_default();
    if Path::new(&name).file_name() == Some("trikfs".as_ref()) {
        return trikfs::cli::main();
    }
    trik::cli::main()
}
