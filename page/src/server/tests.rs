//! The server as clients see it, good ones and others: a tree of plain files, and a robot that is a socket of this test.

use super::*;
use crate::client::Socket;
use crate::guests::Guests;
use crate::limits;
use std::fs;
use std::io::{Read, Write};
use std::net::{IpAddr, TcpListener, TcpStream};
use std::sync::atomic::AtomicBool;
use std::sync::atomic::Ordering::Relaxed;
use std::time::{Duration, Instant};

/// A page over a tree of files, and the listener of its robot.
struct Scene {
    page: Page,
    robot: TcpListener,
    home: tempfile::TempDir,
    fails: Arc<AtomicBool>,
}

/// Which computers may do what: those of this machine, as the test says.
struct ByWord {
    look: bool,
    drive: bool,
    /// A connection meets a mistake of ours.
    fails: Arc<AtomicBool>,
}

impl Guests for ByWord {
    fn comes(&self, _: IpAddr) {
        assert!(!self.fails.load(Relaxed), "a test wants that");
    }

    fn may_look(&self, _: IpAddr) -> bool {
        self.look
    }

    fn may_drive(&self, _: IpAddr) -> bool {
        self.drive
    }

    fn asks(&self, _: IpAddr) {}
}

fn scene(look: bool, drive: bool) -> Scene {
    scene_with(look, drive, true)
}

fn scene_with(look: bool, drive: bool, configures: bool) -> Scene {
    let home = tempfile::tempdir().unwrap();
    let motor = home.path().join("tree/motors/M1");
    fs::create_dir_all(&motor).unwrap();
    fs::create_dir_all(home.path().join("programs")).unwrap();
    for (file, text) in [
        ("value", "0\n"),
        ("format", "i8 power"),
        ("bin_data", "\0"),
        ("units", "%"),
    ] {
        fs::write(motor.join(file), text).unwrap();
    }
    fs::write(home.path().join("tree/stop"), "").unwrap();
    fs::write(home.path().join("tree/config"), "trikfs = {}").unwrap();
    fs::write(home.path().join("tree/status"), "config ok: 0 nodes\n").unwrap();
    fs::write(home.path().join("programs/a.js"), "print(1)").unwrap();
    let robot = TcpListener::bind("127.0.0.1:0").unwrap();
    let fails = Arc::<AtomicBool>::default();
    let guests = ByWord {
        look,
        drive,
        fails: fails.clone(),
    };
    let page = Page::start(Settings {
        address: "127.0.0.1:0".parse().unwrap(),
        name: "test".to_owned(),
        tree: home.path().join("tree"),
        programs: Some(home.path().join("programs")),
        studio: Some(home.path().join("studio")),
        world: None,
        playback: None,
        configures,
        guests: Arc::new(guests),
    })
    .unwrap();
    page.robot_is_at(robot.local_addr().unwrap());
    Scene {
        page,
        robot,
        home,
        fails,
    }
}

impl Scene {
    fn connect(&self) -> TcpStream {
        let stream = TcpStream::connect(self.page.address()).unwrap();
        stream
            .set_read_timeout(Some(Duration::from_secs(60)))
            .unwrap();
        stream
    }

    /// The answer to a request with these headers beside `Host`, until the server closes.
    fn get(&self, path: &str, host: &str, headers: &str) -> String {
        let mut stream = self.connect();
        let request =
            format!("GET {path} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n{headers}\r\n");
        stream.write_all(request.as_bytes()).unwrap();
        let mut answer = Vec::new();
        stream.read_to_end(&mut answer).unwrap();
        String::from_utf8_lossy(&answer).into_owned()
    }

    fn host(&self) -> String {
        self.page.address().to_string()
    }

    /// The header with our cookie.
    fn cookie(&self) -> String {
        let answer = self.get("/plain", &self.host(), "");
        let line = answer
            .lines()
            .find_map(|line| line.strip_prefix("set-cookie: "))
            .unwrap();
        format!("Cookie: {}\r\n", line.split(';').next().unwrap())
    }

    /// A browser that looks, and the robot's end of its connection.
    fn browser(&self) -> (Socket, TcpStream) {
        let mut stream = self.connect();
        let request = format!(
            "GET /socket HTTP/1.1\r\nHost: {}\r\n{}Connection: Upgrade\r\nUpgrade: websocket\r\n\
             Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n",
            self.host(),
            self.cookie()
        );
        stream.write_all(request.as_bytes()).unwrap();
        let mut socket = Socket { stream };
        let head = socket.head();
        assert!(head.starts_with("HTTP/1.1 101 "), "{head}");
        let (robot, _) = self.robot.accept().unwrap();
        robot
            .set_read_timeout(Some(Duration::from_secs(60)))
            .unwrap();
        (socket, robot)
    }

    /// The motor has a value for its rest; false: the filesystem of the test has no attributes.
    fn gives_rest(&self) -> bool {
        let motor = self.home.path().join("tree/motors/M1/value");
        let flags = rustix::fs::XattrFlags::empty();
        rustix::fs::setxattr(&motor, "user.trik.rest", b"0", flags).is_ok()
    }

    fn motor(&self) -> String {
        fs::read_to_string(self.home.path().join("tree/motors/M1/value")).unwrap()
    }
}

/// Waits until something holds.
fn eventually(what: &str, holds: impl Fn() -> bool) {
    let end = Instant::now() + Duration::from_secs(60);
    while !holds() {
        assert!(Instant::now() < end, "{what}");
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// Reads frames of the robot until one is this.
fn robot_hears(robot: &mut TcpStream, wanted: &str) {
    let mut decoder = frame::Decoder::new(limits::MESSAGE_BYTES_MAX);
    let mut buffer = [0; 4096];
    loop {
        let size = robot.read(&mut buffer).unwrap();
        assert!(size > 0, "the connection ended before '{wanted}'");
        decoder.feed(&buffer[..size]);
        while let Some(frame) = decoder.next().unwrap() {
            if frame == wanted.as_bytes() {
                return;
            }
        }
    }
}

#[test]
fn only_the_page_itself_gets_at_the_robot() {
    let scene = scene(true, true);
    let host = scene.host();
    let cookie = scene.cookie();
    let status = |path: &str, host: &str, headers: &str| {
        let answer = scene.get(path, host, headers);
        answer.split(' ').nth(1).unwrap().to_owned()
    };
    assert_eq!(status("/programs", &host, &cookie), "200");
    assert_eq!(status("/programs", &host, ""), "403");
    assert_eq!(status("/programs", &host, "Cookie: trik-1=00\r\n"), "403");
    assert_eq!(status("/socket", &host, ""), "403");
    assert_eq!(status("/plain", "evil.example", ""), "403");
    assert_eq!(status("/plain", "", ""), "403");
    let evil = format!("{cookie}Origin: http://evil.example\r\n");
    assert_eq!(status("/programs", &host, &evil), "403");
    let own = format!("{cookie}Origin: http://{host}\r\n");
    assert_eq!(status("/programs", &host, &own), "200");
    for path in [
        "/diagram/../secret",
        "/diagram/%2e%2e/secret",
        "/diagram//etc/passwd",
        "/diagram/b.js",
    ] {
        assert_eq!(status(path, &host, &cookie), "404", "{path}");
    }
    assert_eq!(status("/diagram/a.js", &host, &cookie), "422");
    let answer = scene.get("/none", &host, "");
    assert!(answer.starts_with("HTTP/1.1 404 "), "{answer}");
    for header in [
        "content-security-policy: default-src 'none'",
        "x-frame-options: DENY",
    ] {
        assert!(answer.contains(header), "{answer}");
    }
}

#[test]
fn a_computer_that_is_not_admitted_sees_nothing() {
    let scene = scene(false, true);
    let answer = scene.get("/plain", &scene.host(), "");
    assert!(answer.starts_with("HTTP/1.1 403 "), "{answer}");
    assert!(!answer.contains("set-cookie"), "{answer}");
}

#[test]
fn a_browser_drives_and_what_it_drives_rests_when_it_is_gone() {
    let scene = scene(true, true);
    let has_rest = scene.gives_rest();
    let (mut browser, mut robot) = scene.browser();
    // What the robot says of programs of blocks is for who looks.
    robot_hears(&mut robot, "language:en");
    browser.until("\"is\":\"hello\"");
    browser.order(r#"{"do":"write","path":"motors/M1","value":"30"}"#);
    // What was written and who is in control are two pieces of news: either may come first.
    browser.until_all(&["\"mine\":true", "\"is\":\"written\""]);
    assert_eq!(scene.motor(), "30\n");
    browser.send(2, b"version");
    robot_hears(&mut robot, "version");
    robot.write_all(b"3:one15:stream:\x00\x01bytes.").unwrap();
    let (kind, first) = loop {
        let message = browser.next().unwrap();
        if message.0 == 2 {
            break message;
        }
    };
    assert_eq!((kind, first.as_str()), (2, "one"));
    browser.until("stream:");
    drop(browser);
    if has_rest {
        eventually("rest after the browser", || scene.motor() == "0\n");
    }
}

#[test]
fn after_a_panic_the_page_is_served_again_and_who_was_there_stays() {
    let scene = scene(true, true);
    let has_rest = scene.gives_rest();
    let (mut browser, _robot) = scene.browser();
    browser.order(r#"{"do":"write","path":"motors/M1","value":"30"}"#);
    browser.until("\"is\":\"written\"");
    scene.fails.store(true, Relaxed);
    for _ in 0..2 {
        // Nobody answers; the connection is cut.
        let mut stream = scene.connect();
        let _ = stream.write_all(b"GET /plain HTTP/1.1\r\n\r\n");
        assert!(matches!(stream.read(&mut [0; 64]), Ok(0) | Err(_)));
    }
    scene.fails.store(false, Relaxed);
    let answer = scene.get("/plain", &scene.host(), "");
    assert!(answer.starts_with("HTTP/1.1 200 "), "{answer}");
    browser.order(r#"{"do":"write","path":"motors/M1","value":"40"}"#);
    browser.until("\"value\":\"40\"");
    drop(browser);
    if has_rest {
        eventually("rest after the browser", || scene.motor() == "0\n");
    }
}

#[test]
fn one_is_in_control_and_everybody_may_stop() {
    let scene = scene(true, true);
    let has_rest = scene.gives_rest();
    let (mut first, _robot) = scene.browser();
    let (mut second, mut robot) = scene.browser();
    first.order(r#"{"do":"write","path":"motors/M1","value":"30"}"#);
    first.until("\"mine\":true");
    second.until("\"who\":\"127.0.0.1\"");
    second.order(r#"{"do":"write","path":"motors/M1","value":"99"}"#);
    second.until("is in control");
    second.send(2, b"run:a.js");
    second.until("is in control");
    second.send(2, b"status");
    robot_hears(&mut robot, "status");
    // The past is for all that may act, also while another one does.
    second.send(2, b"box");
    robot_hears(&mut robot, "box");
    second.order(r#"{"do":"stop"}"#);
    robot_hears(&mut robot, "stop");
    let stop = scene.home.path().join("tree/stop");
    eventually("the tree is told", || {
        fs::read_to_string(&stop).unwrap() == "1"
    });
    assert_eq!(scene.motor(), "30\n");
    // The stop has made a new beginning: what is moved now rests when another one takes control.
    first.order(r#"{"do":"write","path":"motors/M1","value":"40"}"#);
    first.until("\"value\":\"40\"");
    second.order(r#"{"do":"take"}"#);
    first.until("\"mine\":false");
    if has_rest {
        eventually("rest after a change of control", || scene.motor() == "0\n");
    }
    second.send(2, b"run:a.js");
    robot_hears(&mut robot, "run:a.js");
    drop(second);
    first.until("\"who\":null");
}

#[test]
fn a_computer_that_may_only_look_changes_nothing() {
    let scene = scene(true, false);
    let (mut browser, mut robot) = scene.browser();
    browser.until("\"drives\":false");
    for order in [
        r#"{"do":"write","path":"motors/M1","value":"30"}"#,
        r#"{"do":"take"}"#,
        r#"{"do":"world","order":"pause"}"#,
        r#"{"do":"configure","text":"x"}"#,
    ] {
        browser.order(order);
        browser.until("this computer may only look");
    }
    for request in [&b"run:a.js"[..], b"box"] {
        browser.send(2, request);
        browser.until("this computer may only look");
    }
    browser.send(2, b"status");
    robot_hears(&mut robot, "status");
    assert_eq!(scene.motor(), "0\n");
}

#[test]
fn one_in_control_replaces_the_configuration_if_the_page_may() {
    let scene = scene(true, true);
    let config = || fs::read_to_string(scene.home.path().join("tree/config")).unwrap();
    let (mut browser, _robot) = scene.browser();
    browser.until("\"configures\":true");
    let (mut other, _robot) = scene.browser();
    other.order(r#"{"do":"take"}"#);
    other.until("\"mine\":true");
    browser.order(r#"{"do":"configure","text":"mine"}"#);
    browser.until("is in control");
    assert_eq!(config(), "trikfs = {}");
    drop(other);
    browser.until("\"who\":null");
    // Longer than words of an order may be.
    let long = "-".repeat(limits::WORDS_BYTES_MAX + 1);
    browser.order(&format!(r#"{{"do":"configure","text":"{long}"}}"#));
    browser.until("\"is\":\"configured\",\"why\":null");
    assert_eq!(config(), long);
    let cookie = scene.cookie();
    let answer = scene.get("/configuration", &scene.host(), &cookie);
    assert!(
        answer.contains("\"status\":\"config ok: 0 nodes\""),
        "{answer}"
    );
    let answer = scene.get("/configuration", &scene.host(), "");
    assert!(answer.starts_with("HTTP/1.1 403"), "{answer}");
}

#[test]
fn a_page_that_may_not_configure_says_what_allows_it() {
    let scene = scene_with(true, true, false);
    let (mut browser, _robot) = scene.browser();
    browser.until("\"configures\":false");
    browser.order(r#"{"do":"configure","text":"x"}"#);
    browser.until("trikd --page-configures allows it");
}

#[test]
fn the_studio_is_given_file_by_file_with_the_robot_in_its_page() {
    let scene = scene(true, true);
    let home = scene.home.path();
    let gone = scene.get("/studio/", &scene.host(), "");
    assert!(gone.starts_with("HTTP/1.1 404 "), "{gone}");
    fs::create_dir_all(home.join("studio/assets")).unwrap();
    let head = "<head>\n    <meta charset=\"utf-8\" />\n</head>";
    fs::write(home.join("studio/index.html"), head).unwrap();
    fs::write(home.join("studio/sw.js"), "1").unwrap();
    let large = "x".repeat(3 * limits::STUDIO_PIECE_BYTES + 7);
    fs::write(home.join("studio/assets/a.js"), &large).unwrap();
    fs::write(home.join("studio/assets/m.wasm.gz"), "packed").unwrap();
    fs::write(home.join("secret.txt"), "secret").unwrap();

    let page = scene.get("/studio/", &scene.host(), "");
    assert!(page.starts_with("HTTP/1.1 200 ") && page.contains("set-cookie: trik"));
    assert!(
        page.contains("<meta name=\"trik-robot\" content=\"/\" />\n</head>"),
        "{page}"
    );
    assert!(page.contains("'wasm-unsafe-eval'") && page.contains("frame-ancestors 'none'"));
    let module = scene.get("/studio/assets/m.wasm", &scene.host(), "");
    for part in [
        "content-encoding: gzip",
        "application/wasm",
        "content-length: 6",
        "\r\n\r\npacked",
        "'wasm-unsafe-eval'",
    ] {
        assert!(module.contains(part), "{part}: {module}");
    }
    let script = scene.get("/studio/assets/a.js", &scene.host(), "");
    assert!(
        script.contains("immutable")
            && script.ends_with(&large)
            && !script.contains("content-encoding")
    );
    for path in [
        "..%2fsecret.txt",
        "%2e%2e/secret.txt",
        "assets",
        "assets%2f..%2f..%2fsecret.txt",
        "%00",
        "none.js",
        "/etc/passwd",
    ] {
        let answer = scene.get(&format!("/studio/{path}"), &scene.host(), "");
        assert!(
            answer.starts_with("HTTP/1.1 40") && !answer.contains("secret"),
            "{path}: {answer}"
        );
    }
    let elsewhere = scene.get("/studio/", "evil.example", "");
    assert!(elsewhere.starts_with("HTTP/1.1 403 "), "{elsewhere}");
}

#[test]
fn a_save_is_given_byte_for_byte_to_the_page_alone() {
    let scene = scene(true, false);
    let bytes: Vec<u8> = (0..=255).collect();
    fs::write(scene.home.path().join("programs/a.qrs"), &bytes).unwrap();
    let stranger = scene.get("/save/a.qrs", &scene.host(), "");
    assert!(stranger.starts_with("HTTP/1.1 403 "), "{stranger}");
    let mut stream = scene.connect();
    let request = format!(
        "GET /save/a.qrs HTTP/1.1\r\nHost: {}\r\nConnection: close\r\n{}\r\n",
        scene.host(),
        scene.cookie()
    );
    stream.write_all(request.as_bytes()).unwrap();
    let mut answer = Vec::new();
    stream.read_to_end(&mut answer).unwrap();
    assert!(answer.ends_with(&bytes));
    let large = fs::File::create(scene.home.path().join("programs/b.qrs")).unwrap();
    large.set_len(limits::PROGRAM_BYTES_MAX as u64 + 1).unwrap();
    let refused = scene.get("/save/b.qrs", &scene.host(), &scene.cookie());
    assert!(refused.starts_with("HTTP/1.1 422 "), "{refused}");
}

#[test]
fn a_program_is_a_text_that_can_be_read() {
    let scene = scene(true, true);
    let cookie = scene.cookie();
    let answer = scene.get("/program/a.js", &scene.host(), &cookie);
    assert!(answer.ends_with("\r\n\r\nprint(1)"), "{answer}");
    for (path, why) in [
        ("/program/none.py", "404"),
        ("/program/..%2ftree%2fstop", "404"),
    ] {
        let answer = scene.get(path, &scene.host(), &cookie);
        assert!(answer.starts_with(&format!("HTTP/1.1 {why}")), "{answer}");
    }
    let answer = scene.get("/program/a.js", &scene.host(), "");
    assert!(answer.starts_with("HTTP/1.1 403"), "{answer}");
}

#[test]
fn rubbish_is_refused_in_words_and_the_connection_lives() {
    let scene = scene(true, true);
    let (mut browser, _robot) = scene.browser();
    for rubbish in ["", "{", "[]", "{\"do\":\"fly\"}", "\u{0}"] {
        browser.order(rubbish);
        browser.until("is no order");
    }
    browser.order(r#"{"do":"write","path":"../../x","value":"1"}"#);
    browser.until("is no actuator");
    browser.order(r#"{"do":"world","order":"pause"}"#);
    browser.until("a real robot has no world");
    // More than there is room for, which is more than any robot answers.
    for _ in 0..10_000 {
        browser.send(1, b"x");
    }
    browser.order(r#"{"do":"write","path":"motors/M1","value":"5"}"#);
    browser.until("\"is\":\"written\"");
    assert_eq!(scene.motor(), "5\n");
}

#[test]
fn only_an_upload_may_be_long_and_all_that_wait_have_one_room() {
    let scene = scene(true, true);
    let (mut browser, mut robot) = scene.browser();
    browser.until("\"there\":true");
    browser.send(2, &[b'x'; 70_000]);
    browser.until("a request of 70000 bytes: at most 65536");
    // A robot that does not read: what fits nowhere waits here, and no more than there is room for.
    let upload = [&b"file:a.js:"[..], &vec![b'x'; 12 << 20]].concat();
    for _ in 0..4 {
        browser.send(2, &upload);
    }
    browser.until("other uploads wait for the robot");
    // The tree is told at once, and the robot before what waits.
    browser.order(r#"{"do":"stop"}"#);
    let stop = scene.home.path().join("tree/stop");
    eventually("the tree is told", || {
        fs::read_to_string(&stop).unwrap() == "1"
    });
    robot_hears(&mut robot, "stop");
}

#[test]
fn a_computer_that_may_only_look_sends_nothing_large() {
    let scene = scene(true, false);
    let (mut browser, _robot) = scene.browser();
    browser.until("\"drives\":false");
    // The server may close as soon as it has read the length.
    let _ = browser.try_send(2, &[b'x'; 70_000]);
    while browser.next().is_some() {}
}

#[test]
fn a_robot_that_goes_and_comes_back_is_found_again() {
    let scene = scene(true, true);
    let (mut browser, robot) = scene.browser();
    browser.until("\"there\":true");
    drop(robot);
    browser.until("\"there\":false");
    let (_robot, _) = scene.robot.accept().unwrap();
    browser.until("\"there\":true");
}

#[test]
fn too_many_connections_do_not_keep_the_others_from_working() {
    let scene = scene(true, true);
    let (mut browser, _robot) = scene.browser();
    let idle: Vec<TcpStream> = (0..300)
        .filter_map(|_| TcpStream::connect(scene.page.address()).ok())
        .collect();
    browser.order(r#"{"do":"write","path":"motors/M1","value":"7"}"#);
    browser.until("\"is\":\"written\"");
    drop(idle);
    eventually("others come in again", || {
        let mut stream = TcpStream::connect(scene.page.address()).unwrap();
        let request = format!("GET /none HTTP/1.0\r\nHost: {}\r\n\r\n", scene.host());
        let mut answer = String::new();
        stream.write_all(request.as_bytes()).is_ok()
            && stream.read_to_string(&mut answer).is_ok()
            && answer.contains("404")
    });
}

#[test]
fn the_end_is_soon_also_while_browsers_look() {
    let scene = scene(true, true);
    let (mut browser, _robot) = scene.browser();
    browser.until("\"is\":\"hello\"");
    let begin = Instant::now();
    drop(scene.page);
    assert!(begin.elapsed() < Duration::from_secs(60));
    while browser.next().is_some() {}
}
