//! One 4-byte tuple per read(2), against a pipe ping-pong between two processes.

use super::measure::{Plan, row, table, time};
use super::peers::{Mount, NullMount, Peer};
use std::fs::File;
use std::io::Read;

const CONFIG: &str = r"
trikfs = {
  plain = { src = '/dev/zero', input_tuple_size = 4, output_tuple_size = 4 },
  lua = { src = '/dev/zero', input_tuple_size = 4, output_tuple_size = 4,
          converter = function(a_s, a, b_s, b)
            for i = 0, a_s - 1 do ba.set(b, i, ba.get(a, i) % 10 + i + 33) end
          end },
  library = { src = '/dev/zero', input_tuple_size = 4, output_tuple_size = 4,
              converter = { code = [[
int converter(int in_s, char *in, int out_s, char *out) {
  for (int i = 0; i < in_s && i < out_s; i++) out[i] = in[i] % 10 + i + 33;
  return 0;
}]] } },
}";

pub fn run(plan: &Plan) -> Result<(), String> {
    let mut pipe = Peer::start("echo", &["4"])?;
    let null = NullMount::start()?;
    let mount = Mount::start("reads", CONFIG)?;
    let mut null_file =
        File::open(null.place.0.join("device")).map_err(|error| format!("null: {error}"))?;
    let mut files = [
        mount.open("plain/device")?,
        mount.open("library/device")?,
        mount.open("lua/device")?,
    ];
    let [plain, library, lua] = &mut files;
    let samples = plan.samples;
    let read = move |file: &mut File| {
        let mut tuple = [0; 4];
        time(samples, || file.read_exact(&mut tuple).expect("read"))
    };
    let rows = vec![
        row("pipe ping-pong", 0, None, || {
            time(samples, || pipe.ping(&mut [0; 4]))
        }),
        row("null filesystem, native transport", 0, None, || {
            read(&mut null_file)
        }),
        row("device, no converter", 0, None, || read(plain)),
        row("device, library converter", 0, Some(1.50), || read(library)),
        row("device, Lua converter", 0, Some(1.55), || read(lua)),
    ];
    table(
        "read(2) of 4 bytes, ratio to a pipe ping-pong",
        plan.rounds,
        rows,
    );
    Ok(())
}
