//! Many tuples in one read.

use super::measure::{Plan, median, verdict};
use super::peers::Mount;
use std::fs::File;
use std::io::Read;
use std::time::Instant;

const CONFIG: &str = r"
trikfs = {
  plain = { src = '/dev/zero', input_tuple_size = 8 },
  lua = { src = '/dev/zero', input_tuple_size = 8, output_tuple_size = 8,
          converter = function(a_s, a, b_s, b) ba.i32(b, 0, ba.i32(a, 0) + 1) ba.i32(b, 4, ba.i32(a, 4) + 2) end },
  library = { src = '/dev/zero', input_tuple_size = 8, output_tuple_size = 8,
              converter = { code = [[
int converter(int in_s, char *in, int out_s, char *out) {
  for (int i = 0; i < 8; i++) out[i] = in[i] + i;
  return 0;
}]] } },
}";

fn million_tuples_per_s(file: &mut File, bytes: &mut [u8]) -> f64 {
    for _ in 0..20 {
        file.read_exact(bytes).expect("read");
    }
    let start = Instant::now();
    let rounds = 50;
    for _ in 0..rounds {
        file.read_exact(bytes).expect("read");
    }
    (rounds * bytes.len() / 8) as f64 / start.elapsed().as_secs_f64() / 1e6
}

pub fn run(plan: &Plan) -> Result<(), String> {
    let mount = Mount::start("bulk", CONFIG)?;
    let mut bytes = vec![0; 128 << 10];
    println!(
        "\nmany tuples of 8 bytes in one read(2) of 128 KiB; the limit is the same read without a converter"
    );
    let mut limit = 0.0;
    for (name, goal) in [("plain", None), ("library", Some(20.0)), ("lua", Some(5.0))] {
        let mut file = mount.open(&format!("{name}/device"))?;
        let rate = median(
            (0..plan.rounds)
                .map(|_| million_tuples_per_s(&mut file, &mut bytes))
                .collect(),
        );
        if goal.is_none() {
            limit = rate;
        }
        let goal = goal.map_or(String::new(), |goal| {
            format!("goal >= {goal} {}", verdict(rate >= goal))
        });
        println!(
            "{name:<10} {rate:>8.1} million tuples/s {:>6.2} of the limit  {goal}",
            rate / limit
        );
    }
    Ok(())
}
