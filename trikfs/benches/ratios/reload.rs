//! Replacing a configuration of 200 nodes, and a reader that must not notice.

use super::measure::{Plan, median};
use super::peers::Mount;
use std::io::Read;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// 200 Lua nodes, one of which (`counter`) counts its tuples; `extra` changes one other node.
fn config(extra: usize) -> String {
    let mut text = "local function add(k) return function(a_s, a, b_s, b) for i = 0, a_s - 1 do ba.set(b, i, ba.get(a, i) + k) end end end\n".to_owned();
    text.push_str("local n = 0\ntrikfs = {\ncounter = { src = '/dev/zero', input_tuple_size = 4, output_tuple_size = 4, converter = function(a_s, a, b_s, b) ba.u32(b, 0, n) n = n + 1 end },\n");
    for index in 1..200 {
        let value = if index == 1 { 1000 + extra } else { index };
        text.push_str(&format!(
            "n{index} = {{ src = '/dev/zero', input_tuple_size = 4, output_tuple_size = 4, converter = add({value}) }},\n"
        ));
    }
    text + "}\n"
}

pub fn run(plan: &Plan) -> Result<(), String> {
    let mount = Mount::start("reload", &config(0))?;
    let path = mount.file("config");
    let over = AtomicBool::new(false);
    let mut counter = mount.open("counter/device")?;
    let (times, reads) = std::thread::scope(|scope| -> Result<_, String> {
        let reader = scope.spawn(|| {
            let mut expected = 0u32;
            while !over.load(Ordering::Relaxed) {
                let mut tuple = [0; 4];
                counter
                    .read_exact(&mut tuple)
                    .map_err(|error| format!("after {expected} tuples: {error}"))?;
                let got = u32::from_le_bytes(tuple);
                if got != expected {
                    return Err(format!("tuple {got} came instead of {expected}"));
                }
                expected += 1;
            }
            Ok(expected)
        });
        let mut times = Vec::new();
        for round in 1..=plan.rounds * 3 {
            let text = config(round);
            let start = Instant::now();
            let written = std::fs::write(&path, text);
            times.push(start.elapsed().as_secs_f64() * 1000.0);
            if let Err(error) = written {
                over.store(true, Ordering::Relaxed);
                return Err(format!("config: {error}"));
            }
        }
        over.store(true, Ordering::Relaxed);
        let reads = reader
            .join()
            .map_err(|_| "the reader panicked".to_owned())??;
        Ok((times, reads))
    })?;
    let worst = times.iter().copied().fold(0.0, f64::max);
    let middle = median(times);
    println!("\nreload of 200 nodes while one is read without pause");
    let verdict = if middle <= 20.0 { "met" } else { "NOT MET" };
    println!(
        "open, write, close: median {middle:.2} ms, worst {worst:.2} ms   goal <= 20 ms {verdict}"
    );
    println!("the reader of an unchanged node got {reads} tuples in sequence, none missing");
    Ok(())
}
