//! The program `trikfs`; everything it does is in the library's `cli`.

use std::process::ExitCode;

fn main() -> ExitCode {
    trikfs::cli::main()
}
