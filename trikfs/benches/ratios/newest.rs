//! The newest value while a publisher changes it at 1 kHz.

use super::measure::{Plan, row, table, time};
use super::peers::{Mount, Peer, tmpfs_file};
use std::fs::File;
use std::os::unix::fs::FileExt;

/// A node of each size whose bytes are all alike and change every millisecond.
pub fn config(sizes: &[usize]) -> String {
    let mut text = "local function runs(n) local t = {} for i = 1, 250 do t[i] = string.char(i):rep(n) end return table.concat(t) end\ntrikfs = {\n".to_owned();
    for size in sizes {
        text.push_str(&format!(
            "n{size} = {{ src = fake{{ data = runs({size}), period_ms = 0, loop = true }}, input_tuple_size = {size}, poll_ms = 1 }},\n"
        ));
    }
    text + "}\n"
}

/// Waits until the first sample is there: an open before it would not be cached.
pub fn open_when_sampled(mount: &Mount, name: &str) -> Result<File, String> {
    let first = mount.open(name)?;
    first
        .read_at(&mut [0; 64], 0)
        .map_err(|error| format!("{name}: {error}"))?;
    mount.open(name)
}

pub fn run(plan: &Plan) -> Result<(), String> {
    let mount = Mount::start("newest", &config(&[4, 8, 24]))?;
    let tmpfs = tmpfs_file(8)?;
    let mut pipe = Peer::start("echo", &["4"])?;
    let four = open_when_sampled(&mount, "n4/bin_data")?;
    let eight = open_when_sampled(&mount, "n8/bin_data")?;
    let large = open_when_sampled(&mount, "n24/bin_data")?;
    let text = open_when_sampled(&mount, "n4/value")?;
    let samples = plan.samples;
    let pread = move |file: &File, size: usize| {
        let mut tuple = [0; 64];
        time(samples, || {
            assert!(file.read_at(&mut tuple[..size], 0).expect("read") > 0)
        })
    };
    let rows = vec![
        row("tmpfs pread", 0, None, || pread(&tmpfs, 8)),
        row("bin_data of 4 bytes, page cache", 0, Some(1.1), || {
            pread(&four, 4)
        }),
        row("bin_data of 8 bytes, page cache", 0, Some(1.1), || {
            pread(&eight, 8)
        }),
        row("pipe ping-pong", 3, None, || {
            time(samples, || pipe.ping(&mut [0; 4]))
        }),
        row("bin_data of 24 bytes, round trip", 3, Some(1.6), || {
            pread(&large, 24)
        }),
        row("value as text, round trip", 3, Some(1.6), || {
            pread(&text, 64)
        }),
    ];
    table(
        "pread(2) of the newest value at 1 kHz, ratio to tmpfs and to a pipe ping-pong",
        plan.rounds,
        rows,
    );
    Ok(())
}
