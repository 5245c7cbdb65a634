//! The board from outside: sockets, FIFOs and files, as a client of the devices sees them.

mod devices;

use super::*;
use crate::robots;
use nix::sys::socket::{
    AddressFamily, MsgFlags, SockFlag, SockType, UnixAddr, connect, recv, send, socket,
};
use std::os::fd::{AsRawFd, OwnedFd};
use std::path::PathBuf;
use std::time::{Duration, Instant};
use tempfile::{TempDir, tempdir};

fn board(scratch: &TempDir, name: &str) -> Board {
    let body = robots::by_name("two-wheels").unwrap().body();
    Board::start(&scratch.path().join(name), body, Options::default()).unwrap()
}

/// Waits until `condition` gives something.
fn wait<T>(what: &str, mut condition: impl FnMut() -> Option<T>) -> T {
    let deadline = Instant::now() + Duration::from_secs(60);
    loop {
        if let Some(value) = condition() {
            return value;
        }
        assert!(Instant::now() < deadline, "no {what} after a minute");
        std::thread::yield_now();
    }
}

struct Client(OwnedFd);

impl Client {
    fn try_connect(board: &Board, bus: u8) -> nix::Result<Self> {
        let path = board.root().join(format!("dev/i2c-{bus}"));
        let flags = SockFlag::SOCK_CLOEXEC;
        let fd = socket(AddressFamily::Unix, SockType::SeqPacket, flags, None)?;
        connect(fd.as_raw_fd(), &UnixAddr::new(&path)?)?;
        let timeout = nix::sys::time::TimeVal::new(5, 0);
        nix::sys::socket::setsockopt(&fd, nix::sys::socket::sockopt::ReceiveTimeout, &timeout)?;
        Ok(Self(fd))
    }

    fn connect(board: &Board, bus: u8) -> Self {
        Self::try_connect(board, bus).unwrap()
    }

    fn send(&self, packet: &[u8]) {
        send(self.0.as_raw_fd(), packet, MsgFlags::MSG_NOSIGNAL).unwrap();
    }

    fn receive(&self, flags: MsgFlags) -> nix::Result<Vec<u8>> {
        let mut answer = vec![0; 9000];
        let length = recv(self.0.as_raw_fd(), &mut answer, flags)?;
        answer.truncate(length);
        Ok(answer)
    }

    fn request(&self, address: u16, written: &[u8], read: u16) {
        let [low, high] = address.to_le_bytes();
        let mut packet = vec![1, 0, low, high, written.len() as u8, 0];
        packet.extend(read.to_le_bytes());
        packet.extend(written);
        self.send(&packet);
    }

    /// The error and the bytes.
    fn transact(&self, address: u16, written: &[u8], read: u16) -> (i32, Vec<u8>) {
        self.request(address, written, read);
        let answer = self.receive(MsgFlags::empty()).unwrap();
        let error = i32::from_le_bytes(answer[..4].try_into().unwrap());
        (error, answer[4..].to_vec())
    }
}

fn write(board: &Board, name: &str, text: &str) {
    std::fs::write(board.root().join(name), text).unwrap();
}

fn read(board: &Board, name: &str) -> Option<String> {
    std::fs::read_to_string(board.root().join(name)).ok()
}

#[test]
fn a_motor_that_is_written_over_the_bus_moves_the_robot() {
    let scratch = tempdir().unwrap();
    let board = board(&scratch, "board");
    let client = Client::connect(&board, 2);
    assert_eq!(client.transact(0x48, &[0xEE], 2), (0, vec![0x0E, 0x28]));
    assert_eq!(client.transact(0x48, &[0x16, 0xCE], 0), (0, vec![]));
    assert_eq!(client.transact(0x48, &[0x17, 0xCE], 0), (0, vec![]));
    let before = board.view();
    wait("motion", || {
        (board.view().x_m > before.x_m + 0.05).then_some(())
    });
    let view = board.view();
    assert_eq!(view.motors_percent[2..], [Some(50.0), Some(50.0)]);
    assert!(view.encoders_deg[3] > 0.0);
    assert_eq!(view.i2c[1].transactions, 3);
    let (error, bytes) = client.transact(0x48, &[0x32], 4);
    let ticks = i32::from_le_bytes(bytes.try_into().unwrap());
    assert!(error == 0 && ticks > 10, "{ticks}");
}

#[test]
fn other_addresses_and_the_other_bus_do_not_answer() {
    let scratch = tempdir().unwrap();
    let board = board(&scratch, "board");
    assert_eq!(
        Client::connect(&board, 2).transact(0x20, &[0], 1),
        (121, vec![])
    );
    assert_eq!(
        Client::connect(&board, 1).transact(0x48, &[0x26], 2),
        (121, vec![])
    );
}

#[test]
fn malformed_packets_are_told_and_the_connection_lives_on() {
    let scratch = tempdir().unwrap();
    let board = board(&scratch, "board");
    let client = Client::connect(&board, 2);
    let bad: [&[u8]; 4] = [
        &[1],
        &[9, 0, 0x48, 0, 0, 0, 0, 0],
        &[1, 0, 0x48, 0, 9, 0, 0, 0],
        &[0; 9000],
    ];
    for packet in bad {
        client.send(packet);
        let answer = client.receive(MsgFlags::empty()).unwrap();
        assert_eq!(answer.len(), 4);
        assert_ne!(answer, [0; 4]);
    }
    assert_eq!(client.transact(0x48, &[0xEE], 2).0, 0);
}

#[test]
fn a_client_that_never_reads_is_cut_off_and_harms_nobody() {
    let scratch = tempdir().unwrap();
    let board = board(&scratch, "board");
    let lazy = Client::connect(&board, 2);
    let packet = [1, 0, 0x48, 0, 1, 0, 0, 0x20, 0x26];
    let flags = MsgFlags::MSG_NOSIGNAL | MsgFlags::MSG_DONTWAIT;
    wait("end of the connection", || {
        match send(lazy.0.as_raw_fd(), &packet, flags) {
            Err(nix::errno::Errno::EPIPE | nix::errno::Errno::ECONNRESET) => Some(()),
            _ => None,
        }
    });
    assert_eq!(Client::connect(&board, 2).transact(0x48, &[0xEE], 2).0, 0);
}

#[test]
fn a_hundred_connections_are_served_and_far_more_are_refused_not_fatal() {
    let scratch = tempdir().unwrap();
    let board = board(&scratch, "board");
    let clients: Vec<Client> = (0..100).map(|_| Client::connect(&board, 2)).collect();
    for client in &clients {
        assert_eq!(client.transact(0x48, &[0xEE], 2).0, 0);
    }
    // The board closes what is beyond its table; meanwhile the others go on.
    let more: Vec<Client> = (0..60)
        .filter_map(|_| Client::try_connect(&board, 2).ok())
        .collect();
    let closed = more.iter().filter(|client| {
        send(
            client.0.as_raw_fd(),
            &[1, 0, 0x48, 0, 1, 0, 2, 0, 0xEE],
            MsgFlags::MSG_NOSIGNAL,
        )
        .is_err()
            || client
                .receive(MsgFlags::empty())
                .map_or(true, |answer| answer.is_empty())
    });
    assert_eq!(closed.count(), 32, "100 and 28 are 128");
    assert_eq!(clients[0].transact(0x48, &[0xEE], 2).0, 0);
    drop((clients, more));
    wait("room for a new client", || {
        let client = Client::try_connect(&board, 2).ok()?;
        client.request(0x48, &[0xEE], 2);
        client
            .receive(MsgFlags::empty())
            .ok()
            .filter(|answer| answer.len() == 6)
    });
}

#[test]
fn pulses_are_measured_by_the_port_that_was_asked_to() {
    let scratch = tempdir().unwrap();
    let board = board(&scratch, "board");
    let folder = "sys/class/pwm/ecap_cap.1";
    let measured = |what: &str, frequency: &str, duty: &str| {
        wait(what, || {
            let are = |name, text: &str| {
                read(&board, &format!("{folder}/{name}"))?
                    .strip_suffix('\n')?
                    .eq(text)
                    .then_some(())
            };
            are("freq", frequency)?;
            are("duty_percentage", duty)
        });
    };
    measured("nothing", "-1,-1,-1", "-1");
    write(&board, "control/pulses/S2", "50 7\n");
    write(&board, &format!("{folder}/capture"), "1");
    measured("pulses", "50,50,50", "7");
    assert_eq!(
        read(&board, "sys/class/pwm/ecap_cap.2/freq").unwrap(),
        "-1,-1,-1\n"
    );
    write(&board, "control/pulses/S2", "fast\n");
    let complaint = wait("a complaint", || read(&board, "control/pulses/S2.error"));
    assert!(complaint.starts_with("'fast' is not a frequency from 1 to 100000 Hz"));
    write(&board, "control/pulses/S2", "0\n");
    measured("the end", "-1,-1,-1", "-1");
    wait("no complaint", || {
        read(&board, "control/pulses/S2.error")
            .is_none()
            .then_some(())
    });
    write(&board, "control/pulses/S2", "100000 100\n");
    measured("fast ones", "100000,100000,100000", "100");
    write(&board, &format!("{folder}/capture"), "0");
    measured("a servo", "-1,-1,-1", "-1");
}

#[test]
fn servos_leds_and_gpio_are_files() {
    let scratch = tempdir().unwrap();
    let board = board(&scratch, "board");
    write(&board, "sys/class/pwm/pwmchip5/pwm1/period", "20000000");
    write(&board, "sys/class/pwm/pwmchip5/pwm1/enable", "1");
    write(
        &board,
        "sys/class/pwm/pwmchip5/pwm1/duty_cycle",
        "1415000\n",
    );
    wait("pulse on S6", || {
        (board.view().servos_ns[5] == 1_415_000).then_some(())
    });
    write(&board, "sys/class/pwm/pwmchip5/pwm1/enable", "0");
    wait("end of the pulse", || {
        (board.view().servos_ns == [0; 6]).then_some(())
    });
    write(&board, "sys/class/leds/led_red/brightness", "1");
    wait("red light", || {
        (board.view().led == (false, true)).then_some(())
    });
    write(&board, "sys/class/gpio/gpio94/direction", "high");
    wait("level", || {
        (read(&board, "sys/class/gpio/gpio94/value")? == "1\n").then_some(())
    });
    write(&board, "sys/class/gpio/export", "52");
    wait("exported line", || {
        read(&board, "sys/class/gpio/gpio52/value")
    });
    write(&board, "sys/class/gpio/export", "100000");
    assert_eq!(read(&board, "sys/class/gpio/gpio56/value").unwrap(), "1\n");
}

#[test]
fn faults_are_put_in_and_taken_out_through_files() {
    let scratch = tempdir().unwrap();
    let board = board(&scratch, "board");
    let client = Client::connect(&board, 2);
    write(&board, "faults/msp430", "nack\n");
    wait("NACK", || {
        (client.transact(0x48, &[0xEE], 2).0 == 121).then_some(())
    });
    write(&board, "faults/msp430", "nonsense");
    let reason = wait("complaint", || read(&board, "faults/msp430.error"));
    assert!(
        reason.starts_with("there is no fault 'nonsense' here; possible are unplug"),
        "{reason}"
    );
    std::fs::remove_file(board.root().join("faults/msp430")).unwrap();
    wait("answer", || {
        (client.transact(0x48, &[0xEE], 2).0 == 0).then_some(())
    });
    wait("end of the complaint", || {
        read(&board, "faults/msp430.error").is_none().then_some(())
    });
    write(&board, "faults/msp43O", "nack");
    let reason = wait("complaint", || read(&board, "faults/msp43O.error"));
    assert!(reason.starts_with("there is no device 'msp43O' on this board; there are msp430"));
}

#[test]
fn a_folder_of_faults_that_is_removed_or_moved_away_mends_all_and_is_there_again() {
    let scratch = tempdir().unwrap();
    let board = board(&scratch, "board");
    let client = Client::connect(&board, 2);
    let folder = board.root().join("faults");
    for is_removed in [true, false] {
        // Also the first one after the loss is seen.
        wait("NACK", || {
            let _ = std::fs::write(folder.join("msp430"), "nack\n");
            (client.transact(0x48, &[0xEE], 2).0 == 121).then_some(())
        });
        if is_removed {
            std::fs::remove_dir_all(&folder).unwrap();
        } else {
            std::fs::rename(&folder, board.root().join("aside")).unwrap();
        }
        wait("answer", || {
            (client.transact(0x48, &[0xEE], 2).0 == 0).then_some(())
        });
    }
}

#[test]
fn an_unplugged_bus_is_gone_and_comes_back() {
    let scratch = tempdir().unwrap();
    let board = board(&scratch, "board");
    let client = Client::connect(&board, 2);
    write(&board, "faults/i2c-2", "unplug");
    wait("end of the node", || {
        (!board.root().join("dev/i2c-2").exists()).then_some(())
    });
    assert!(client.receive(MsgFlags::empty()).unwrap().is_empty());
    assert_eq!(
        Client::connect(&board, 1).transact(1, &[], 0).0,
        121,
        "the other bus is there"
    );
    std::fs::remove_file(board.root().join("faults/i2c-2")).unwrap();
    let client = wait("the node", || Client::try_connect(&board, 2).ok());
    assert_eq!(client.transact(0x48, &[0xEE], 2).0, 0);
}

#[test]
fn a_slow_bus_takes_its_time_and_the_other_one_does_not() {
    let scratch = tempdir().unwrap();
    let board = board(&scratch, "board");
    let (slow, other) = (Client::connect(&board, 2), Client::connect(&board, 1));
    write(&board, "faults/i2c-2", "slow 60000");
    // Sent until one of them is late.
    wait("a late answer", || {
        slow.request(0x48, &[0xEE], 2);
        let deadline = Instant::now() + Duration::from_millis(100);
        while Instant::now() < deadline {
            if slow.receive(MsgFlags::MSG_DONTWAIT).is_ok() {
                return None;
            }
        }
        Some(())
    });
    assert_eq!(other.transact(1, &[], 0).0, 121);
    std::fs::remove_file(board.root().join("faults/i2c-2")).unwrap();
    assert_eq!(
        slow.receive(MsgFlags::empty()).unwrap().len(),
        6,
        "the fault ended while it waited"
    );
}

#[test]
fn a_stuck_bus_never_answers() {
    let scratch = tempdir().unwrap();
    let board = board(&scratch, "board");
    let client = Client::connect(&board, 2);
    write(&board, "faults/i2c-2", "stuck");
    wait("silence", || {
        let before = board.view().i2c[1].transactions;
        client.request(0x48, &[0xEE], 2);
        wait("transaction", || {
            (board.view().i2c[1].transactions > before).then_some(())
        });
        client.transact_is_silent().then_some(())
    });
}

impl Client {
    /// Whether an answer that is due has not come: a later transaction of another client is done by then.
    fn transact_is_silent(&self) -> bool {
        let deadline = Instant::now() + Duration::from_millis(50);
        while Instant::now() < deadline {
            if self.receive(MsgFlags::MSG_DONTWAIT).is_ok() {
                return false;
            }
        }
        true
    }
}

#[test]
fn two_boards_side_by_side_are_two_boards() {
    let scratch = tempdir().unwrap();
    let (one, two) = (board(&scratch, "one"), board(&scratch, "two"));
    Client::connect(&one, 2).transact(0x48, &[0x14, 30], 0);
    wait("motor of one", || {
        (one.view().motors_percent[0] == Some(30.0)).then_some(())
    });
    assert_eq!(two.view().motors_percent[0], Some(0.0));
}

#[test]
fn a_directory_of_somebody_else_is_refused_and_left_alone() {
    let scratch = tempdir().unwrap();
    std::fs::create_dir(scratch.path().join("theirs")).unwrap();
    std::fs::write(scratch.path().join("theirs/letter"), "dear").unwrap();
    let start = |path: PathBuf| {
        let body = robots::by_name("two-wheels").unwrap().body();
        Board::start(&path, body, Options::default())
    };
    let refused = start(scratch.path().join("theirs")).err().unwrap();
    assert!(
        refused
            .to_string()
            .contains("is not empty and not the directory of a board"),
        "{refused}"
    );
    assert!(scratch.path().join("theirs/letter").exists());
    let first = start(scratch.path().join("board")).unwrap();
    let refused = start(scratch.path().join("board")).err().unwrap();
    assert!(
        refused.to_string().contains("another board runs here"),
        "{refused}"
    );
    assert_eq!(Client::connect(&first, 2).transact(0x48, &[0xEE], 2).0, 0);
    drop(first);
    assert!(!scratch.path().join("board").exists());
    // What a killed board leaves is taken over.
    std::fs::create_dir_all(scratch.path().join("board/dev")).unwrap();
    std::fs::write(scratch.path().join("board/.virtual-board"), "").unwrap();
    std::fs::write(scratch.path().join("board/dev/i2c-2"), "").unwrap();
    assert_eq!(
        Client::connect(&start(scratch.path().join("board")).unwrap(), 2)
            .transact(0x48, &[0xEE], 2)
            .0,
        0
    );
    // An empty directory stays.
    std::fs::create_dir(scratch.path().join("empty")).unwrap();
    drop(start(scratch.path().join("empty")).unwrap());
    assert_eq!(
        std::fs::read_dir(scratch.path().join("empty"))
            .unwrap()
            .count(),
        0
    );
}

#[test]
fn a_speed_that_cannot_be_is_refused() {
    let scratch = tempdir().unwrap();
    for speed in [0.0, -1.0, f64::NAN, 1e9] {
        let body = robots::by_name("two-wheels").unwrap().body();
        let options = Options {
            speed,
            ..Options::default()
        };
        assert!(Board::start(&scratch.path().join("board"), body, options).is_err());
        assert!(!scratch.path().join("board").exists());
    }
}
