//! Programs of data flow as nodes: in Lua and in C, side by side on one mount, as `trik gen` writes them and read by trikfs
//! itself.

use crate::{is_of_the_controller, mount_on, trikfs};
use harness::Board;
use lang_dataflow::check::check;
use lang_dataflow::generate::{Target, generate};

const STRAIGHT: &str = include_str!("../../../examples/dataflow/straight.flow");

/// The shipped program that fuses encoders and gyroscope, written in a language.
fn straight(target: Target) -> String {
    let project = lang_dataflow::text::read(STRAIGHT).expect("the shipped program");
    generate(&check(&project).program, target).expect("a converter")
}

#[test]
fn both_languages_show_the_same_heading_of_the_same_sensors() {
    let board = Board::new();
    board.file("straight.lua", straight(Target::Lua));
    for name in ["l", "r", "g"] {
        board.fifo(name);
    }
    let config = format!(
        "trikfs = {{
           left = {{ src = '$DIR/l', format = 'i32 angle', on_event = true }},
           right = {{ src = '$DIR/r', format = 'i16 angle', on_event = true }},
           gyro = {{ src = '$DIR/g', format = 'f32 a, f32 b, f32 c, f32 t, f32 x, f32 y, f32 yaw', on_event = true }},
           lua = dataflow {{
             program = 'straight.lua', shows = {{ 'heading', 'M3', 'M4' }},
             inputs = {{ encoder3 = 'left', encoder4 = {{ 'right', type = 'i16' }}, gyroscope = {{ 'gyro', type = 'f32' }} }},
           }},
           c = {{
             src = {{ encoder3 = 'newest:left', encoder4 = 'newest:right', gyroscope = 'newest:gyro' }}, interval = true,
             poll_ms = 20, always = true, mode = 0444, format = 'f64 heading, f64 M3, f64 M4',
             converter = {{ code = [==[
#define TYPE_encoder4 i16
#define TYPE_gyroscope f32
#define FIELDS(FIELD) FIELD(heading) FIELD(M3) FIELD(M4)
{}]==] }},
           }},
         }}",
        straight(Target::C)
    );
    let Some(m) = mount_on(board, &config) else {
        return;
    };
    m.python(
        "left, right, gyro = feed('l'), feed('r'), feed('g')
def tell(a, b, yaw):
    os.write(gyro, struct.pack('<7f', 0, 0, 0, 0, 0, 0, yaw))
    os.write(right, struct.pack('<h', b))
    os.write(left, struct.pack('<i', a))
def both():
    return [answer(M + '/%s/value' % name).split() for name in ('lua', 'c')]
assert text(M + '/lua/format') == text(M + '/c/format')
tell(0, 0, 0)
# Nothing turns: the heading stays where it begins.
eventually(lambda: both() == [['0', '60', '60']] * 2, 'the first numbers')
# The gyroscope alone: the filter comes to it in the end, and the wheels turn against it.
tell(0, 0, 20000)
there = lambda shown: 19.9 < float(shown[0]) <= 20 and shown[1:] == ['30', '90']
eventually(lambda: all(len(shown) == 3 and there(shown) for shown in both()), 'the heading of the gyroscope')
",
    );
}

#[test]
fn a_program_that_fails_is_a_fault_of_its_node_in_both_languages() {
    let board = Board::new();
    board.fifo("in");
    let node = |language: &str| {
        format!(
            "dataflow {{ language = '{language}', shows = 'share', inputs = {{ sensorA1 = 'a' }}, program = [[
               diagram \"Share\"
                 a: Sensor(VarName = sensorA1)
                 f: \"Text programming\"(IO0 = `share = 100 / I0`)
                 a.OUT -> f.I0
             ]] }}"
        )
    };
    let config = format!(
        "trikfs = {{ a = {{ src = '$DIR/in', format = 'i32 value', on_event = true }}, lua = {}, c = {} }}",
        node("lua"),
        node("c")
    );
    if is_of_the_controller() {
        board.file("robot.lua", &config);
        let said = trikfs(&board, &["check", "robot.lua"], b"");
        assert_ne!(said.code(), 0);
        let told = "takes programs of data flow as Lua alone";
        assert!(said.stderr.contains(told), "{}", said.stderr);
        return;
    }
    let Some(m) = mount_on(board, &config) else {
        return;
    };
    m.python(
        "pipe = feed('in')
for number, wanted in ((8, '12.5\\n'), (0, 'EIO'), (4, '25\\n')):
    os.write(pipe, struct.pack('<i', number))
    for name in ('lua', 'c'):
        eventually(lambda: answer(M + '/%s/value' % name) == wanted, '%s of %d' % (name, number))
        if wanted == 'EIO':
            assert 'f.I0: division by 0' in text(M + '/%s/fault' % name), text(M + '/%s/fault' % name)
",
    );
}
