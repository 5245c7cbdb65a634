//! `status`: the result of the last configuration, then one line for each node.

use crate::mount_on;
use harness::Board;

#[test]
fn every_node_has_a_line_with_its_state_rate_and_fault() {
    let board = Board::new();
    board.fifo("event");
    let Some(m) = mount_on(
        board,
        "trikfs = {
          absent = { src = '$DIR/absent', input_tuple_size = 1 },
          event = { src = '$DIR/event', input_tuple_size = 1, on_event = true },
          polled = { src = '/dev/zero', input_tuple_size = 1, poll_ms = 2 },
          zero = { src = '/dev/zero', input_tuple_size = 1 },
        }",
    ) else {
        return;
    };
    m.errno("absent/device");
    let line = |name: &str| {
        let text = m.text("status");
        let found = text
            .lines()
            .find(|line| line.starts_with(name))
            .unwrap_or_default()
            .to_owned();
        (text.lines().count(), found)
    };
    assert_eq!(m.result(), "config ok: 4 nodes");
    assert_eq!(line("zero").0, 5);
    assert_eq!(line("zero").1, "zero ready 0.0Hz -");
    assert_eq!(line("event").1, "event waiting 0.0Hz -");
    assert!(
        line("absent").1.starts_with("absent fault 0.0Hz device: "),
        "{}",
        line("absent").1
    );
    harness::eventually("a rate", || {
        let line = line("polled").1;
        let rate = line
            .strip_prefix("polled sampled ")
            .and_then(|rest| rest.split("Hz").next()?.parse::<f64>().ok());
        rate.is_some_and(|rate| rate > 10.0)
    });
}

#[test]
fn a_reader_in_small_pieces_sees_one_text() {
    let board = Board::new();
    let Some(m) = mount_on(
        board,
        "trikfs = { polled = { src = '/dev/zero', input_tuple_size = 1, poll_ms = 1 } }",
    ) else {
        return;
    };
    for _ in 0..20 {
        let text = m.sh("dd if=status bs=1 2>/dev/null");
        assert_eq!(text.lines().count(), 2, "{text}");
        assert!(text.ends_with("Hz -\n"), "{text}");
    }
}
