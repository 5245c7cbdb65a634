//! The program `trikd`.

use std::process::ExitCode;

fn main() -> ExitCode {
    trikd::cli::main()
}
