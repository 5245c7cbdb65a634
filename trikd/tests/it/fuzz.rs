//! The fuzz targets of the decoders, each for a moment.

use harness::fuzz::run;

#[test]
fn frames_of_strange_clients_do_no_harm() {
    let samples: &[&[u8]] = &[
        b"7:version13:configVersion9:keepalive",
        b" 7 :version0:-5:abc:+2:ok99999999999:3:a:b",
        b"2147483647:x",
        b"4:data5:ports9:sensor:A1",
    ];
    run("frames", trikd::fuzz::fuzz_frames, samples);
    let messages: &[&[u8]] = &[
        b"file:a/b.js:text",
        b"file:../x:y",
        b"run:a.py",
        b"sensor:GyroscopePortX",
        b"sensor:button:Left",
        b"register:8889:7",
        b"connection:127.0.0.1:8896:9",
        b"connection:fe80::1:8889:-2",
        b"data:a:b",
        b"pad 1 -100 100 ",
        b"btn 3 down",
        b"custom a b",
    ];
    run("messages", trikd::fuzz::fuzz_messages, messages);
}

#[test]
fn a_program_that_says_anything_does_no_harm() {
    let samples: &[&[u8]] = &[
        b"print:a\n",
        b"mail:-1:a:b",
        b"watch:main: Timer\n{}",
        b"mailbox:join 127.0.0.1 8889 2",
        b"send -1 a b",
        b"join 127.0.0.1 8889 2",
        b"connect 127.0.0.1",
        b"hull 7",
        b"debug:7 8 break {b}\nif n > 3",
        b"debug:0 {}",
        b"debug-left:",
    ];
    run("channel", trikd::fuzz::fuzz_channel, samples);
}

#[test]
fn lines_and_requests_of_strangers_do_no_harm() {
    let lines: &[&[u8]] = &[b"pad 1 0 0\nwheel 5\n", b"\xd0\xb0\n\xff", &[b'x'; 300]];
    run("lines", trikd::fuzz::fuzz_lines, lines);
    let strangers: &[&[u8]] = &[
        b"GET /?action=stream HTTP/1.1\r\nHost: x\r\n\r\n",
        b"\0\x07\0\0\0\x01\0\0\0\0\0\0\x05_trik\x04_tcp\x05local\0\0\x0c\0\x01",
        b"\0\x07\0\0\0\x02\0\0\0\0\0\0\xc0\x0c\0\x0c\0\x01",
    ];
    run("strangers", trikd::fuzz::fuzz_strangers, strangers);
}
