//! Actuators whose converters are isolated: they move, and their rest does not need the process.

use super::{process_of, signal};
use crate::mount_on;
use harness::wait::eventually;
use harness::{Board, Mount, processes};
use nix::sys::signal::Signal;

/// Adds the param `zero` or takes it away; crashes at 99, hangs at 98, and is slow at 97.
const SHIFT: &str = r#"
#include "trikfs_converter.h"
#include <stdlib.h>
#include <time.h>
static void work(long ms)
{
    struct timespec from, now;
    clock_gettime(CLOCK_MONOTONIC, &from);
    do clock_gettime(CLOCK_MONOTONIC, &now);
    while ((now.tv_sec - from.tv_sec) * 1000 + (now.tv_nsec - from.tv_nsec) / 1000000 < ms);
}
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
{ if (in[0] == 99) __builtin_trap(); while (in[0] == 98) { } if (in[0] == 97) work(1500); out[0] = in[0] - *(signed char *)state; return in_size != out_size; }
static const trikfs_converter first = { TRIKFS_ABI_VERSION, sizeof(trikfs_converter), "up", 0, 1, 1, open_it, up, free, 0 };
static const trikfs_converter second = { TRIKFS_ABI_VERSION, sizeof(trikfs_converter), "down", 0, 1, 1, open_it, down, free, 0 };
static const trikfs_converter *const all[] = { &first, &second };
static const trikfs_library library = { TRIKFS_ABI_VERSION, sizeof(trikfs_library), 2, all };
TRIKFS_EXPORT const trikfs_library *trikfs_library_entry(void) { return &library; }
"#;

/// A motor whose device has `zero` less than what is written; `more` are further fields and nodes.
fn motor(more: &str) -> Option<(Mount, String)> {
    motor_on(Board::new(), more)
}

fn motor_on(board: Board, more: &str) -> Option<(Mount, String)> {
    board.file("motor", [0; 1]);
    board.library("shift.so", SHIFT);
    let config = format!(
        "trikfs = {{ motor = {{ src = attribute{{ path = '$DIR/motor' }}, input_tuple_size = 1, format = 'i8 power', isolate = true,
      params = {{ zero = 1 }}, converter = 'shift.so#up', write_converter = 'shift.so#down', {more} }}"
    );
    let m = mount_on(board, &config)?;
    let config = m.board().fill_in(&config);
    Some((m, config))
}

/// What the motor's device has.
fn device(m: &Mount) -> u8 {
    m.board().content("motor")[0]
}

#[test]
fn an_actuator_whose_converter_is_isolated_moves_and_rests() {
    let Some((m, _)) = motor("rest = 0 }") else {
        return;
    };
    m.write("motor/value", "30").unwrap();
    assert_eq!(device(&m), 29);
    assert_eq!(m.text("motor/value").trim(), "30");
    let error = m.write("motor/value", "99").unwrap_err();
    assert_eq!(error.raw_os_error(), Some(libc::EIO));
    assert_eq!(device(&m), 29, "a wrong number never moves a motor");
    m.write("stop", "1").unwrap();
    assert_eq!(device(&m), 0xff, "at rest, as its converter has it");
}

#[test]
fn a_rest_does_not_depend_on_the_process_of_the_converter() {
    let Some((m, _)) = motor("rest = 5 }") else {
        return;
    };
    for how in [Signal::SIGKILL, Signal::SIGSTOP] {
        eventually("a write", || m.write("motor/value", "30").is_ok());
        assert_eq!(device(&m), 29, "{how}");
        signal(process_of(&m), how);
        m.write("stop", "1").unwrap();
        assert_eq!(device(&m), 4, "{how}");
    }
    // The bytes are those of the params of now.
    let refused = m.write("motor/params/zero", "3").unwrap_err();
    let errno = refused.raw_os_error();
    assert_eq!(errno, Some(libc::EIO), "nobody can be asked");
    eventually("a param", || m.write("motor/params/zero", "3").is_ok());
    eventually("a write", || m.write("motor/value", "30").is_ok());
    assert_eq!(device(&m), 27);
    m.write("stop", "1").unwrap();
    assert_eq!(device(&m), 2, "with the new zero");
    eventually("a param", || m.write("motor/params/zero", "1").is_ok());
    // A program that has made it crash again and again, and is gone then.
    eventually("a write", || m.write("motor/value", "30").is_ok());
    m.try_sh("exec 3> motor/device; printf ' ' >&3; for n in 1 2 3; do printf c >&3; done");
    eventually("rest after the program", || device(&m) == 4);
}

#[test]
fn a_rest_through_another_node_needs_no_process_and_has_the_params_of_that_node() {
    let through = "} } trikfs.arm = { src = 'trikfs:motor', input_tuple_size = 1, format = 'i8 power', rest = 7, write_converter = function(a_s, a, b_s, b) ba.set(b, 0, ba.get(a, 0)) end";
    let Some((m, _)) = motor(through) else { return };
    m.write("arm/value", "30").unwrap();
    assert_eq!(device(&m), 29);
    signal(process_of(&m), Signal::SIGSTOP);
    m.write("stop", "1").unwrap();
    assert_eq!(device(&m), 6);
    eventually("a param", || m.write("motor/params/zero", "3").is_ok());
    eventually("rest", || m.write("stop", "1").is_ok());
    assert_eq!(device(&m), 4, "not what was converted with the former zero");
}

#[test]
fn the_guardian_rests_an_actuator_whose_process_was_dead_at_the_last_configuration() {
    let Some((m, config)) = motor("rest = 5 }") else {
        return;
    };
    m.write("motor/value", "30").unwrap();
    // It crashes twice, so there is a pause in which nothing is converted.
    for _ in 0..2 {
        let _ = m.write("motor/value", "99");
    }
    let more = "trikfs.more = { src = '/dev/zero', input_tuple_size = 1 }";
    m.apply(&format!("{config} {more}")).unwrap();
    assert_eq!(device(&m), 29);
    signal(m.daemon(), Signal::SIGKILL);
    eventually("rest by the guardian", || device(&m) == 4);
}

/// A motor that a regulator drives by what is ordered of it; `lamp` is another actuator.
const REGULATED: &str = "budget_us = 2000000, rest = 5 }, lamp = { src = attribute{ path = '$DIR/lamp' }, input_tuple_size = 1, format = 'u8 light', rest = 7 },
   speed = { src = regulator{ feedback = 'trikfs:lamp', actuator = 'trikfs:motor' }, poll_ms = 20, format = 'u8 speed',
     converter = function(a_s, a, b_s, b) ba.set(b, 0, ba.get(a, 0)) end,
     write_converter = function(a_s, a, b_s, b) ba.set(b, 0, ba.get(a, 0)) end }";

#[test]
fn a_regulated_actuator_rests_at_once_while_a_write_to_it_hangs_in_its_converter() {
    // By a program, and by the regulator, which hangs in a step; of a write that is only slow the rest has the last word.
    for (node, value, hangs) in [
        ("motor/value", "98", true),
        ("speed/value", "98", true),
        ("motor/value", "97", false),
        ("speed/value", "97", false),
    ] {
        let board = Board::new();
        board.file("lamp", [0; 1]);
        let Some((m, _)) = motor_on(board, REGULATED) else {
            return;
        };
        m.write("lamp/value", "90").unwrap();
        m.write("speed/value", "30").unwrap();
        eventually("a step", || device(&m) == 29);
        let process = process_of(&m);
        std::thread::scope(|scope| {
            let busy = scope.spawn(|| m.write(node, value));
            // Longer than a step of the regulator.
            let mut looks = 0;
            eventually("it works", || {
                looks = if processes::is_asleep(process) {
                    0
                } else {
                    looks + 1
                };
                looks > 5
            });
            let stop = scope.spawn(|| m.write("stop", "1"));
            eventually("rest", || {
                device(&m) == 4 && m.board().content("lamp") == [7]
            });
            if hangs {
                assert!(!busy.is_finished(), "{node}: its rest waits for nobody");
            }
            stop.join().unwrap().unwrap();
            assert_eq!(device(&m), 4, "{node} {value}");
            assert_eq!(busy.join().unwrap().is_err(), hangs, "{node} {value}");
        });
        // Each sample would be a step.
        for light in [55, 56] {
            m.board().file("lamp", [light]);
            let text = format!("{light}\n");
            let shown = || {
                m.read("speed/value")
                    .is_ok_and(|got| got == text.as_bytes())
            };
            eventually("a sample", shown);
        }
        assert_eq!(device(&m), 4, "{node} {value}: it stays at rest");
    }
}
