//! Actuators whose converters are isolated: they move, and their rest does not need the process.

use super::{process_of, signal};
use crate::mount_on;
use harness::Board;
use harness::wait::eventually;
use nix::sys::signal::Signal;
use std::time::{Duration, Instant};

/// Adds the param `zero` or takes it away; crashes at 99.
const SHIFT: &str = r#"
#include "trikfs_converter.h"
#include <stdlib.h>
static int open_it(const trikfs_open_info *info, void **state)
{
    signed char *zero = calloc(1, 1);
    for (uint32_t i = 0; zero && i < info->param_count; i++)
        *zero = (signed char)info->params[i].value;
    *state = zero;
    return !zero;
}
static int up(void *state, const uint8_t *in, uint32_t in_size, uint8_t *out, uint32_t out_size)
{ out[0] = in[0] + *(signed char *)state; return in_size != out_size; }
static int down(void *state, const uint8_t *in, uint32_t in_size, uint8_t *out, uint32_t out_size)
{ if (in[0] == 99) __builtin_trap(); out[0] = in[0] - *(signed char *)state; return in_size != out_size; }
static const trikfs_converter first = { TRIKFS_ABI_VERSION, sizeof(trikfs_converter), "up", 0, 1, 1, open_it, up, free, 0 };
static const trikfs_converter second = { TRIKFS_ABI_VERSION, sizeof(trikfs_converter), "down", 0, 1, 1, open_it, down, free, 0 };
static const trikfs_converter *const all[] = { &first, &second };
static const trikfs_library library = { TRIKFS_ABI_VERSION, sizeof(trikfs_library), 2, all };
TRIKFS_EXPORT const trikfs_library *trikfs_library_entry(void) { return &library; }
"#;

#[test]
fn an_actuator_whose_converter_is_isolated_moves_and_rests() {
    let board = Board::new();
    board.file("motor", [0; 1]);
    let config = "trikfs = { motor = { src = attribute{ path = '$DIR/motor' }, input_tuple_size = 1, format = 'i8 power', rest = 0, isolate = true,
      converter = { code = 'int converter(int a, char *in, int b, char *out) { out[0] = in[0] + 1; return 0; }' },
      write_converter = { code = 'int converter(int a, char *in, int b, char *out) { if (in[0] == 99) __builtin_trap(); out[0] = in[0] - 1; return 0; }' } } }";
    let Some(m) = mount_on(board, config) else {
        return;
    };
    m.write("motor/value", "30").unwrap();
    assert_eq!(m.board().content("motor"), [29]);
    assert_eq!(m.text("motor/value").trim(), "30");
    let error = m.write("motor/value", "99").unwrap_err();
    assert_eq!(error.raw_os_error(), Some(libc::EIO));
    assert_eq!(
        m.board().content("motor"),
        [29],
        "a wrong number never moves a motor"
    );
    m.write("stop", "1").unwrap();
    assert_eq!(
        m.board().content("motor"),
        [0xff],
        "at rest, by its converter"
    );
}

#[test]
fn a_rest_does_not_depend_on_the_process_of_the_converter() {
    let board = Board::new();
    board.file("motor", [0; 1]);
    board.library("shift.so", SHIFT);
    let config = "trikfs = { motor = { src = attribute{ path = '$DIR/motor' }, input_tuple_size = 1, format = 'i8 power', rest = 5, isolate = true,
      params = { zero = 1 }, converter = 'shift.so#up', write_converter = 'shift.so#down' } }";
    let Some(m) = mount_on(board, config) else {
        return;
    };
    let motor = || m.board().content("motor");
    for how in [Signal::SIGKILL, Signal::SIGSTOP] {
        eventually("a write", || m.write("motor/value", "30").is_ok());
        assert_eq!(motor(), [29], "{how}");
        signal(process_of(&m), how);
        let start = Instant::now();
        m.write("stop", "1").unwrap();
        assert_eq!(motor(), [4], "{how}");
        assert!(start.elapsed() < Duration::from_millis(500), "{how}");
    }
    // The bytes are those of the params of now.
    let refused = m.write("motor/params/zero", "3").unwrap_err();
    assert_eq!(
        refused.raw_os_error(),
        Some(libc::EIO),
        "nobody can be asked"
    );
    eventually("a param", || m.write("motor/params/zero", "3").is_ok());
    eventually("a write", || m.write("motor/value", "30").is_ok());
    assert_eq!(motor(), [27]);
    m.write("stop", "1").unwrap();
    assert_eq!(motor(), [2], "with the new zero");
    eventually("a param", || m.write("motor/params/zero", "1").is_ok());
    // A program that has made it crash again and again, and is gone then.
    eventually("a write", || m.write("motor/value", "30").is_ok());
    m.try_sh("exec 3> motor/device; printf ' ' >&3; for n in 1 2 3; do printf c >&3; done");
    eventually("rest after the program", || motor() == [4]);
}

#[test]
fn the_guardian_rests_an_actuator_whose_process_was_dead_at_the_last_configuration() {
    let board = Board::new();
    board.file("motor", [0; 1]);
    board.library("shift.so", SHIFT);
    let config = "trikfs = { motor = { src = attribute{ path = '$DIR/motor' }, input_tuple_size = 1, format = 'i8 power', rest = 5, isolate = true,
      params = { zero = 1 }, converter = 'shift.so#up', write_converter = 'shift.so#down' } }";
    let Some(m) = mount_on(board, config) else {
        return;
    };
    m.write("motor/value", "30").unwrap();
    // It crashes twice, so there is a pause in which nothing is converted.
    for _ in 0..2 {
        let _ = m.write("motor/value", "99");
    }
    m.apply(&format!(
        "{} trikfs.more = {{ src = '/dev/zero', input_tuple_size = 1 }}",
        m.board().fill_in(config)
    ))
    .unwrap();
    assert_eq!(m.board().content("motor"), [29]);
    signal(m.daemon(), Signal::SIGKILL);
    eventually("rest by the guardian", || m.board().content("motor") == [4]);
}
