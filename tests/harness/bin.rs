//! The program `trikfs` once more, built with the tests so that they know where it is.

use std::process::ExitCode;

fn main() -> ExitCode {
    trikfs::cli::main()
}
