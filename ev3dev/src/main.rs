//! The program `trikfs-ev3dev`; everything it does is in the library's `cli`.

use std::process::ExitCode;

fn main() -> ExitCode {
    trikfs_ev3dev::cli::main()
}
