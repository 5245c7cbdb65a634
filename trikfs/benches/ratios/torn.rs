//! Ten million reads of each size against a publisher: is a value ever half old, half new?

use super::measure::Plan;
use super::newest::{config, open_when_sampled};
use super::peers::Mount;
use std::os::unix::fs::FileExt;

const READS: u32 = 10_000_000;

pub fn run(_plan: &Plan) -> Result<(), String> {
    let sizes = [1, 2, 4, 8, 24, 64];
    let mount = Mount::start("torn", &config(&sizes))?;
    println!("\n{READS} preads of bin_data each, the value changing at 1 kHz");
    for size in sizes {
        let file = open_when_sampled(&mount, &format!("n{size}/bin_data"))?;
        let mut tuple = vec![0; size];
        let (mut torn, mut changes, mut last) = (0u32, 0u32, 0);
        for _ in 0..READS {
            let n = file
                .read_at(&mut tuple, 0)
                .map_err(|error| error.to_string())?;
            if n != size || tuple.iter().any(|&byte| byte != tuple[0]) {
                torn += 1;
            }
            changes += u32::from(tuple[0] != last);
            last = tuple[0];
        }
        println!("{size:>3} bytes: {torn} torn, {changes} values seen");
        if torn > 0 || changes < 100 {
            return Err(format!("{size} bytes: {torn} torn, {changes} values seen"));
        }
    }
    Ok(())
}
