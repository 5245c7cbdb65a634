//! Shared libraries: the plain symbol, the versioned table, parameters, replacement on disk.

use crate::mount_on;
use harness::Board;

const PLUS: &str = "int converter(int in_s, char *in, int out_s, char *out)
{ for (int i = 0; i < out_s; i++) out[i] = in[i] + PLUS; return in[0] == '!' ? 7 : 0; }";

/// Counts from the param `start`; `!` is a fault, `-` gives nothing yet.
pub(super) const COUNTING: &str = r#"
#include "trikfs_converter.h"
#include <stdlib.h>
static int open_it(const trikfs_open_info *info, void **state)
{
    double start = 0;
    for (uint32_t i = 0; i < info->param_count; i++)
        start = info->params[i].value;
    if (start < 0)
        return 9;
    info->log(info->host, "opened");
    unsigned char *count = malloc(1);
    if (!count)
        return 1;
    *count = (unsigned char)start;
    *state = count;
    return 0;
}
static int convert_it(void *state, const uint8_t *in, uint32_t in_size, uint8_t *out, uint32_t out_size)
{
    (void)in_size;
    (void)out_size;
    if (in[0] == '!')
        return 5;
    if (in[0] == '-')
        return TRIKFS_CONSUMED;
    out[0] = ++*(unsigned char *)state;
    return TRIKFS_OK;
}
static const char *explain_it(void *state, int code) { (void)state; return code == 9 ? "start is at least 0" : "an exclamation mark"; }
static const trikfs_converter counting = { TRIKFS_ABI_VERSION, sizeof(trikfs_converter), "counting", "Counts.", 1, 1, open_it, convert_it, free, explain_it };
static const trikfs_converter twin = { TRIKFS_ABI_VERSION, sizeof(trikfs_converter), "twin", 0, 0, 0, open_it, convert_it, free, 0 };
static const trikfs_converter *const all[] = { &counting, &twin };
static const trikfs_library library = { TRIKFS_ABI_VERSION, sizeof(trikfs_library), 2, all };
TRIKFS_EXPORT const trikfs_library *trikfs_library_entry(void) { return &library; }
"#;

#[test]
fn a_plain_library_beside_the_configuration_is_found_and_its_code_is_a_fault() {
    let board = Board::new();
    board.library("plus.so", &PLUS.replace("PLUS", "1"));
    board.fifo("in");
    let Some(m) = mount_on(
        board,
        "trikfs = { n = { src = '$DIR/in', input_tuple_size = 2, output_tuple_size = 2, converter = 'plus.so' } }",
    ) else {
        return;
    };
    m.python(
        "fd, pipe = open_ro(M + '/n/device'), feed('in')
os.write(pipe, b'ab')
assert os.read(fd, 2) == b'bc'
os.write(pipe, b'!bcd')
expect('EIO', os.read, fd, 2)
assert text(M + '/n/fault').startswith('converter: ') and '7' in text(M + '/n/fault')
assert os.read(fd, 2) == b'de'
",
    );
}

#[test]
fn a_versioned_library_has_a_state_for_each_open_file_and_explains_itself() {
    let board = Board::new();
    board.library("counting.so", COUNTING);
    board.fifo("in");
    let node = |name: &str, start: i32| {
        format!(
            "{{ src = '$DIR/in', input_tuple_size = 1, output_tuple_size = 1, params = {{ start = {start} }}, converter = {{ library = 'counting.so', name = '{name}' }} }}"
        )
    };
    let config = format!(
        "trikfs = {{ n = {}, twin = {} }}",
        node("counting", 10),
        node("twin", 0)
    );
    let Some(m) = mount_on(board, &config) else {
        return;
    };
    m.python(
        "one, pipe = open_ro(M + '/n/device'), feed('in')
os.write(pipe, b'a-b')
assert read_exactly(one, 2) == bytes([11, 12])
two = open_ro(M + '/n/device')
os.write(pipe, b'cd')
assert read_exactly(two, 2) == bytes([11, 12])
assert read_exactly(one, 2) == bytes([13, 14])
os.write(pipe, b'!')
expect('EIO', os.read, one, 1)
assert text(M + '/n/fault') == 'converter: counting.so#counting: an exclamation mark\\n', text(M + '/n/fault')
",
    );
    let refused = m.apply(&format!("trikfs = {{ bad = {} }}", node("counting", -1)));
    assert!(refused.is_err());
    let status = m.text("status");
    assert!(
        status.starts_with(
            "config refused: config:1: node bad: counting.so#counting: start is at least 0\n"
        ),
        "{status}"
    );
    assert!(
        m.sh("dd if=log iflag=nonblock bs=64k count=1 2>/dev/null")
            .contains("n: opened")
    );
}

#[test]
fn a_library_that_is_replaced_on_disk_is_used_after_the_next_reload() {
    let board = Board::new();
    board.library("plus.so", &PLUS.replace("PLUS", "1"));
    board.file("in", "a");
    let config = "trikfs = { n = { src = '$DIR/in', input_tuple_size = 1, output_tuple_size = 1, converter = 'plus.so' } }";
    let Some(m) = mount_on(board, config) else {
        return;
    };
    let old = m.open("n/device");
    for plus in 2u8..6 {
        m.board()
            .library("plus.so", &PLUS.replace("PLUS", &plus.to_string()));
        assert_eq!(m.read("n/bin_data").unwrap(), [b'a' + plus - 1]);
        m.apply(config).unwrap();
        assert_eq!(m.read("n/bin_data").unwrap(), [b'a' + plus]);
    }
    let error = std::os::unix::fs::FileExt::read_at(&old, &mut [0; 1], 0).unwrap_err();
    assert_eq!(error.raw_os_error(), Some(libc::ESTALE));
}

#[test]
fn libraries_that_are_none_are_refused_by_name() {
    let board = Board::new();
    board.library("counting.so", COUNTING);
    board.library("nothing.so", "int nothing;");
    board.file("text.so", "not a library");
    board.file("elf.so", b"\x7fELF\x02\x01\x01");
    board.library(
        "future.so",
        &COUNTING.replace("library = { TRIKFS_ABI_VERSION", "library = { 2"),
    );
    let Some(m) = mount_on(board, "trikfs = {}") else {
        return;
    };
    for (converter, words) in [
        ("'nothing.so'", "nothing.so"),
        ("'text.so'", "text.so"),
        ("'elf.so'", "elf.so"),
        ("'absent.so'", "absent.so"),
        ("'future.so#counting'", "version"),
        ("'counting.so'", "counting, twin"),
        ("'counting.so#contuing'", "counting"),
        ("{ library = 'counting.so', name = 'other' }", "other"),
        ("'mnt/config'", "mnt/config"),
    ] {
        let line = m.apply(&format!("trikfs = {{\nn = {{ src = '/dev/zero', input_tuple_size = 1, output_tuple_size = 1, converter = {converter} }} }}")).expect_err(converter);
        assert!(
            line.starts_with("config refused: config:2: ") && line.contains(words),
            "{converter}: {line}"
        );
    }
    let line = m.apply("trikfs = { n = { src = '/dev/zero', input_tuple_size = 3, output_tuple_size = 3, converter = 'counting.so#counting' } }").map_or_else(|line| line, |()| {
        let errno = m.errno("n/device");
        assert_eq!(errno, libc::EIO);
        m.text("n/fault")
    });
    assert!(line.contains('3') && line.contains('1'), "{line}");
}
