//! Texts for programs: one run for each, one after the other, nobody waits, and nothing but the text reaches it.

use crate::mount_on;
use harness::{Board, eventually};
use std::os::unix::fs::PermissionsExt;

const SCRIPT: &str = r#"#!/bin/sh
{ printf '%s|' "$@"; echo; } >> $DIR/said
while [ -e $DIR/busy ]; do sleep 0.01; done
[ "$2" != fail ] || { echo 'no voice'; exit 3; }
"#;

/// A program that notes its arguments, and waits while there is a file `busy`.
fn board() -> Board {
    let board = Board::new();
    let path = board.file("say", board.fill_in(SCRIPT));
    std::fs::set_permissions(path, std::fs::Permissions::from_mode(0o755)).unwrap();
    board.file("said", "");
    board
}

const CONFIG: &str = "trikfs = {
  say = { src = program{ run = { '$DIR/say', 'loud' } }, format = 'text 12' },
  plain = { src = program{ run = { '$DIR/say', 'loud', '--' } }, format = 'text 12' },
  gone = { src = program{ run = { '$DIR/absent' } }, format = 'text 12' },
}";

#[test]
fn each_text_is_the_last_argument_of_one_run() {
    let Some(m) = mount_on(board(), CONFIG) else {
        return;
    };
    let texts = [
        "hello",
        "two words\n",
        "$(id) `id`;\"",
        "\u{44d}\u{445}\u{43e}",
    ];
    for text in texts {
        m.write("say/value", text).unwrap();
    }
    let expected: String = texts
        .iter()
        .map(|text| format!("loud|{}|\n", text.trim()))
        .collect();
    eventually("all four", || {
        m.board().content("said") == expected.as_bytes()
    });
    m.python(
        "def put(data, name='say/value'):
    fd = os.open(M + '/' + name, os.O_WRONLY)
    try:
        os.write(fd, data)
    finally:
        os.close(fd)
expect('ERANGE', put, b'1234567890123')
expect('EINVAL', put, b'-v evil')
expect('EINVAL', put, b'two\\nlines')
expect('EINVAL', put, b'\\xff')
expect('EINVAL', put, b'  ')
expect('ENODEV', put, b'hello', 'gone/value')
expect('EACCES', open_ro, M + '/say/value')
put(b'fail')
",
    );
    eventually("the failure in the log", || {
        let log = m.log();
        log.contains("say: no voice") && log.contains("say ended with exit status: 3")
    });
    assert_eq!(m.text("say/format"), "text 12\n");
    // Where options end a text is none.
    m.write("plain/value", "-5").unwrap();
    eventually("a negative number", || {
        m.board().content("said").ends_with(b"loud|--|-5|\n")
    });
}

#[test]
fn a_busy_program_keeps_eight_waiting_and_no_more() {
    let board = board();
    board.file("busy", "");
    let Some(m) = mount_on(board, CONFIG) else {
        return;
    };
    m.write("say/value", "0").unwrap();
    eventually("the first run", || {
        m.board().content("said") == b"loud|0|\n"
    });
    for number in 1..=8 {
        m.write("say/value", number.to_string()).unwrap();
    }
    let refused = m.write("say/value", "9").unwrap_err();
    assert_eq!(refused.raw_os_error(), Some(libc::EBUSY));
    std::fs::remove_file(m.board().path("busy")).unwrap();
    let expected: String = (0..=8).map(|number| format!("loud|{number}|\n")).collect();
    eventually("the rest in order", || {
        m.board().content("said") == expected.as_bytes()
    });
}

#[test]
fn the_end_of_the_mount_ends_a_program_that_does_not_end() {
    let board = board();
    board.file("busy", "");
    let Some(mut m) = mount_on(board, CONFIG) else {
        return;
    };
    m.write("say/value", "0").unwrap();
    m.write("say/value", "1").unwrap();
    eventually("the first run", || {
        m.board().content("said") == b"loud|0|\n"
    });
    assert!(m.stop().success());
    assert_eq!(m.board().content("said"), b"loud|0|\n");
}
