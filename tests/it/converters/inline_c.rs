//! C source in the configuration: compiled here, kept, and told of with the configuration's own lines.

use crate::{mount_on, trikfs};
use harness::Board;

const NEGATE: &str = "trikfs = {
  n = { src = '$DIR/in', input_tuple_size = 2, output_tuple_size = 2, converter = { code = [[
    #include <stdint.h>
    int converter(int in_s, char *in, int out_s, char *out)
    {
      for (int i = 0; i < out_s; i++)
        out[i] = (char)~(uint8_t)in[i];
      return in[0] == 'x';
    }
  ]] } },
}";

#[test]
fn source_is_compiled_and_converts_in_both_directions() {
    let board = Board::new();
    board.file("in", [0, 1]);
    let Some(m) = mount_on(board, NEGATE) else {
        return;
    };
    assert_eq!(m.read("n/device").unwrap(), [255, 254]);
    m.write("n/device", [0xf0, 0x0f]).unwrap();
    assert_eq!(m.board().content("in"), [0x0f, 0xf0]);
    m.board().file("in", "xy");
    assert_eq!(m.errno("n/device"), libc::EIO);
    assert!(
        m.text("n/fault").starts_with("converter: "),
        "{}",
        m.text("n/fault")
    );
}

#[test]
fn the_versioned_form_is_found_in_source_too() {
    let board = Board::new();
    board.file("in", "abc");
    let Some(m) = mount_on(
        board,
        "trikfs = { n = { src = '$DIR/in', input_tuple_size = 1, output_tuple_size = 1, converter = { code = [[
          #include \"trikfs_converter.h\"
          static int convert(void *s, const uint8_t *in, uint32_t n, uint8_t *out, uint32_t m) { out[0] = in[0] - 32; return TRIKFS_OK; }
          static const trikfs_converter upper = { TRIKFS_ABI_VERSION, sizeof upper, \"upper\", 0, 1, 1, 0, convert, 0, 0 };
          static const trikfs_converter *const all[] = { &upper };
          static const trikfs_library library = { TRIKFS_ABI_VERSION, sizeof library, 1, all };
          TRIKFS_EXPORT const trikfs_library *trikfs_library_entry(void) { return &library; }
        ]] } } }",
    ) else {
        return;
    };
    assert_eq!(m.read("n/device").unwrap(), b"ABC");
}

#[test]
fn errors_stand_at_the_lines_of_the_file() {
    let board = Board::new();
    board.file(
        "robot.lua",
        board.fill_in(&NEGATE.replace("(char)~", "(char)~missing")),
    );
    let output = trikfs(&board, &["check", "--cache", "cache", "robot.lua"], b"");
    assert_eq!(output.code(), 1);
    assert!(
        output.stderr.starts_with("robot.lua:7: "),
        "{}",
        output.stderr
    );
    assert!(output.stderr.contains("missing"), "{}", output.stderr);
}

#[test]
fn the_same_source_is_compiled_once_wherever_it_stands() {
    let board = Board::new();
    board.file("in", [0, 1]);
    // A compiler that leaves a mark each time it runs.
    board.file(
        "cc",
        format!(
            "#!/bin/sh\necho run >> \"$(dirname \"$0\")/runs\"\nexec {} \"$@\"\n",
            harness::tools::c_compiler()
        ),
    );
    std::fs::set_permissions(
        board.path("cc"),
        std::os::unix::fs::PermissionsExt::from_mode(0o755),
    )
    .unwrap();
    let compile = |board: &Board, lines: usize| {
        board.file("robot.lua", "\n".repeat(lines) + &board.fill_in(NEGATE));
        let mut command = std::process::Command::new(crate::program());
        command
            .args(["check", "--cache", "cache", "robot.lua"])
            .current_dir(board.dir())
            .env("CC", board.path("cc"));
        harness::run(&mut command, b"").good();
        std::fs::read_to_string(board.path("runs"))
            .unwrap_or_default()
            .lines()
            .count()
    };
    let once = compile(&board, 0);
    assert!(once >= 1);
    assert_eq!(compile(&board, 0), once);
    assert_eq!(compile(&board, 5), once);
}

#[test]
fn a_compiler_that_is_missing_is_said_to_be() {
    let board = Board::new();
    board.file("robot.lua", board.fill_in(NEGATE));
    let mut command = std::process::Command::new(crate::program());
    command
        .args(["check", "--cache", "cache", "robot.lua"])
        .current_dir(board.dir());
    command.env("PATH", "/nonexistent").env_remove("CC");
    let output = harness::run(&mut command, b"");
    assert_eq!(output.code(), 1);
    assert!(
        output.stderr.starts_with("robot.lua:") && output.stderr.contains("compiler"),
        "{}",
        output.stderr
    );
}
