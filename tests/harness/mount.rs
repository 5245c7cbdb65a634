//! A mounted tree of the program under test, from its start to its end.
//!
//! Owns the processes of one mount. Dropping it stops them and insists on a clean end; a panicking test gets the same
//! without the insistence. A mount that lives too long is cut off by force, so that a hang becomes a failure.

use crate::board::{Board, mounts_below};
use crate::processes;
use crate::tools::{self, Output};
use crate::wait::{LIFE, SOON, eventually, skip};
use nix::mount::{MntFlags, umount2};
use nix::sys::signal::Signal;
use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::{self, BufRead, BufReader, Read, Write};
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// What to mount and how.
pub struct Setting<'a> {
    /// The program under test.
    pub program: &'a str,
    /// Its devices.
    pub board: Board,
    /// The configuration; `$DIR` stands for the board's folder.
    pub config: &'a str,
    /// Further options of `mount`.
    pub options: &'a [&'a str],
    /// Command to put in front (another user, a limit); empty for none.
    pub launcher: &'a [&'a str],
}

/// A mounted tree.
pub struct Mount {
    board: Board,
    mountpoint: PathBuf,
    guardian: Option<Child>,
    complaints: Arc<Mutex<String>>,
    listener: Option<JoinHandle<()>>,
    /// Dropping it tells the one who cuts off late mounts that all is well.
    alive: Sender<Duration>,
    ready_line: String,
}

/// Which transport the tests use: what `TRIK_TRANSPORT` says, or else our own. The build must have it.
pub fn transport() -> String {
    std::env::var("TRIK_TRANSPORT").unwrap_or_else(|_| "native".to_owned())
}

/// Why nothing can be mounted here, if so.
pub fn obstacle() -> Option<&'static str> {
    if File::options()
        .read(true)
        .write(true)
        .open("/dev/fuse")
        .is_err()
    {
        return Some("no /dev/fuse");
    }
    let root = nix::unistd::geteuid().is_root();
    let helper = Command::new("fusermount3").arg("-V").output().is_ok();
    (!root && !helper).then_some("neither root nor fusermount3")
}

impl Mount {
    /// Mounts and waits for the line that says so. None: nothing can be mounted here, which has been said by name.
    ///
    /// # Panics
    /// The program ends instead, or says nothing in time.
    pub fn new(setting: Setting<'_>) -> Option<Self> {
        if let Some(why) = obstacle() {
            skip(why);
            return None;
        }
        let Setting {
            program,
            board,
            config,
            options,
            launcher,
        } = setting;
        let mountpoint = board.path("mnt");
        fs::create_dir_all(&mountpoint).expect("a mount point");
        let file = board.file("robot.lua", board.fill_in(config));
        let mut words: Vec<&OsStr> = launcher.iter().map(OsStr::new).collect();
        words.push(OsStr::new(program));
        let mut command = Command::new(words[0]);
        command
            .args(&words[1..])
            .arg("mount")
            .arg("--config")
            .arg(&file);
        command
            .arg("--cache")
            .arg(board.path("cache"))
            .arg("--transport")
            .arg(transport());
        command.args(options).arg(&mountpoint).process_group(0);
        Some(Self::start(board, mountpoint, &mut command))
    }

    fn start(board: Board, mountpoint: PathBuf, command: &mut Command) -> Self {
        command
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        let mut guardian = command
            .spawn()
            .unwrap_or_else(|error| panic!("{command:?}: {error}"));
        let complaints = Arc::new(Mutex::new(String::new()));
        let (stdout, stderr) = (guardian.stdout.take(), guardian.stderr.take());
        let heard = complaints.clone();
        let listener = std::thread::spawn(move || {
            for line in stderr
                .into_iter()
                .flat_map(|stderr| BufReader::new(stderr).lines())
                .map_while(Result::ok)
            {
                let mut all = heard.lock().unwrap_or_else(PoisonError::into_inner);
                all.push_str(&line);
                all.push('\n');
            }
        });
        let (said, line) = channel();
        std::thread::spawn(move || {
            for line in stdout
                .into_iter()
                .flat_map(|stdout| BufReader::new(stdout).lines())
                .map_while(Result::ok)
            {
                let _ = said.send(line);
            }
        });
        let (alive, life) = channel::<Duration>();
        let (pid, point) = (guardian.id(), mountpoint.clone());
        std::thread::spawn(move || {
            let mut most = LIFE;
            loop {
                match life.recv_timeout(most) {
                    Ok(longer) => most = longer,
                    Err(RecvTimeoutError::Disconnected) => return,
                    Err(RecvTimeoutError::Timeout) => break,
                }
            }
            eprintln!(
                "{} lives for more than {most:?}: it is cut off",
                point.display()
            );
            cut_off(pid, &point);
        });
        let mut mount = Self {
            board,
            mountpoint,
            guardian: Some(guardian),
            complaints,
            listener: Some(listener),
            alive,
            ready_line: String::new(),
        };
        match line.recv_timeout(SOON) {
            Ok(line) => mount.ready_line = line,
            Err(_) => panic!("{command:?} is not ready:\n{}", mount.complaints()),
        }
        mount
    }

    /// It may live for so long from now on.
    pub fn lasts(&self, most: Duration) {
        // The one who cuts it off has done so.
        let _ = self.alive.send(most);
    }

    /// The devices.
    pub fn board(&self) -> &Board {
        &self.board
    }

    /// Where the tree is mounted.
    pub fn root(&self) -> &Path {
        &self.mountpoint
    }

    /// A path in the tree.
    pub fn path(&self, name: &str) -> PathBuf {
        self.mountpoint.join(name)
    }

    /// The line with which the program said that it is ready.
    pub fn ready_line(&self) -> &str {
        &self.ready_line
    }

    /// What the processes have written to standard error so far.
    pub fn complaints(&self) -> String {
        self.complaints
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .clone()
    }

    /// Opens a file of the tree for reading.
    ///
    /// # Panics
    /// It cannot be opened.
    pub fn open(&self, name: &str) -> File {
        File::open(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    /// Whole content of a file of the tree.
    ///
    /// # Errors
    /// The first one met.
    pub fn read(&self, name: &str) -> io::Result<Vec<u8>> {
        let mut bytes = Vec::new();
        File::open(self.path(name))?.read_to_end(&mut bytes)?;
        Ok(bytes)
    }

    /// Whole content of a file of the tree as text.
    ///
    /// # Panics
    /// It cannot be read.
    pub fn text(&self, name: &str) -> String {
        let bytes = self
            .read(name)
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        String::from_utf8(bytes).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    /// The errno that opening and reading a file of the tree gives; 0 if it can be read.
    pub fn errno(&self, name: &str) -> i32 {
        self.read(name)
            .err()
            .map_or(0, |error| error.raw_os_error().unwrap_or(-1))
    }

    /// Writes to a file of the tree with one write(2), without truncating it.
    ///
    /// # Errors
    /// Of open or write.
    pub fn write(&self, name: &str, bytes: impl AsRef<[u8]>) -> io::Result<()> {
        let mut file = File::options().write(true).open(self.path(name))?;
        file.write_all(bytes.as_ref())
    }

    /// A number of a node's `stats`.
    ///
    /// # Panics
    /// There is no such line.
    pub fn stat(&self, node: &str, key: &str) -> f64 {
        let text = self.text(&format!("{node}/stats"));
        let value = text
            .lines()
            .find_map(|line| line.strip_prefix(key)?.strip_prefix(' ')?.parse().ok());
        value.unwrap_or_else(|| panic!("no {key} in:\n{text}"))
    }

    /// First line of `status`.
    pub fn result(&self) -> String {
        self.text("status")
            .lines()
            .next()
            .unwrap_or_default()
            .to_owned()
    }

    /// Brings a configuration into force by writing it to `config`; `$DIR` stands for the board's folder.
    ///
    /// # Errors
    /// The first line of `status`, if fsync(2) refuses it with EINVAL.
    ///
    /// # Panics
    /// Any other error.
    pub fn apply(&self, config: &str) -> Result<(), String> {
        let mut file = File::options()
            .write(true)
            .truncate(true)
            .open(self.path("config"))
            .expect("config opens");
        file.write_all(self.board.fill_in(config).as_bytes())
            .expect("config takes bytes");
        match file.sync_all() {
            Ok(()) => Ok(()),
            Err(error) if error.raw_os_error() == Some(libc::EINVAL) => Err(self.result()),
            Err(error) => panic!("config: {error}"),
        }
    }

    /// Runs a shell script in the tree; `$MNT` and `$DIR` are set.
    pub fn try_sh(&self, script: &str) -> Output {
        tools::run(&mut self.at_home(tools::shell(script)), b"")
    }

    /// Output of a shell script that must succeed.
    pub fn sh(&self, script: &str) -> String {
        self.try_sh(&format!("set -e\n{script}")).good()
    }

    /// What the log holds, at most 64 KiB of it. One read, because a second would wait for the next line.
    pub fn log(&self) -> String {
        let mut bytes = vec![0; 64 << 10];
        let size = self.open("log").read(&mut bytes).expect("log");
        String::from_utf8_lossy(&bytes[..size]).into_owned()
    }

    /// Output of a Python script that must succeed; see `prelude.py` for what it can use.
    pub fn python(&self, script: &str) -> String {
        tools::run(&mut self.at_home(tools::python(script)), b"").good()
    }

    /// A command that runs in the tree with `$MNT` and `$DIR` set.
    pub fn at_home(&self, mut command: Command) -> Command {
        command
            .current_dir(&self.mountpoint)
            .env("MNT", &self.mountpoint)
            .env("DIR", self.board.dir());
        command
    }

    /// Process that guards the mount.
    ///
    /// # Panics
    /// It has been waited for.
    pub fn guardian(&self) -> u32 {
        self.guardian.as_ref().expect("a guardian").id()
    }

    /// Process that serves the tree now.
    ///
    /// # Panics
    /// There is none for too long.
    pub fn daemon(&self) -> u32 {
        let mut found = 0;
        eventually("a daemon", || {
            found = processes::children(self.guardian())
                .first()
                .copied()
                .unwrap_or(0);
            found != 0
        });
        found
    }

    /// True while something is mounted at the mount point.
    pub fn is_mounted(&self) -> bool {
        !mounts_below(&self.mountpoint).is_empty()
    }

    /// Waits for the guardian to end by itself.
    ///
    /// # Panics
    /// It does not in time.
    pub fn wait(&mut self) -> ExitStatus {
        let mut guardian = self.guardian.take().expect("not waited for yet");
        let ended = wait_for(&mut guardian, SOON);
        let Some(status) = ended else {
            cut_off(guardian.id(), &self.mountpoint);
            let _ = guardian.wait();
            panic!(
                "the guardian of {} did not end:\n{}",
                self.mountpoint.display(),
                self.complaints()
            );
        };
        if let Some(listener) = self.listener.take() {
            let _ = listener.join();
        }
        status
    }

    /// Asks the guardian to stop and waits for it.
    pub fn stop(&mut self) -> ExitStatus {
        processes::signal(self.guardian(), Signal::SIGTERM);
        self.wait()
    }

    /// Kills guardian and daemon at one stroke, as a machine that runs out of memory might, and leaves a dead mount.
    pub fn kill_everything(&mut self) {
        let mut guardian = self.guardian.take().expect("a guardian");
        let daemons = processes::children(guardian.id());
        // Stopped first, neither can clean up after the other.
        for &pid in daemons.iter().chain([&guardian.id()]) {
            processes::signal(pid, Signal::SIGSTOP);
        }
        eventually("a standstill", || {
            processes::is_stopped(guardian.id())
                && daemons.iter().all(|&pid| processes::is_stopped(pid))
        });
        // The guardian last: a stopped process that loses its parent is continued by the kernel.
        for &pid in daemons.iter().chain([&guardian.id()]) {
            processes::signal(pid, Signal::SIGKILL);
        }
        let _ = guardian.wait();
        eventually("the end of the daemon", || {
            daemons.iter().all(|&pid| !processes::is_alive(pid))
        });
    }

    /// Gives the devices back for another mount. The tree must be stopped.
    pub fn into_board(mut self) -> Board {
        if self.guardian.is_some() {
            self.stop();
        }
        std::mem::take(&mut self.board)
    }
}

impl Drop for Mount {
    fn drop(&mut self) {
        let Some(mut guardian) = self.guardian.take() else {
            return;
        };
        processes::signal(guardian.id(), Signal::SIGTERM);
        let ended = wait_for(&mut guardian, SOON);
        if ended.is_none() {
            for pid in processes::children(guardian.id())
                .into_iter()
                .chain([guardian.id()])
            {
                eprint!("{}", processes::describe(pid));
            }
            cut_off(guardian.id(), &self.mountpoint);
            let _ = guardian.wait();
        }
        let still_mounted = self.is_mounted();
        if still_mounted {
            let _ = umount2(&self.mountpoint, MntFlags::MNT_DETACH);
        }
        if std::thread::panicking() {
            eprintln!("standard error of the program:\n{}", self.complaints());
        } else {
            let code = ended.map(|status| status.code());
            assert_eq!(
                code,
                Some(Some(0)),
                "the program did not stop well:\n{}",
                self.complaints()
            );
            assert!(!still_mounted, "the program left its mount behind");
        }
    }
}

fn wait_for(child: &mut Child, limit: Duration) -> Option<ExitStatus> {
    let deadline = Instant::now() + limit;
    while Instant::now() < deadline {
        if let Ok(Some(status)) = child.try_wait() {
            return Some(status);
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    None
}

/// Ends a mount by all means: its processes, its connection, its name.
fn cut_off(guardian: u32, mountpoint: &Path) {
    let daemons = processes::children(guardian);
    processes::signal(guardian, Signal::SIGKILL);
    for pid in daemons {
        processes::signal(pid, Signal::SIGKILL);
    }
    let _ = umount2(mountpoint, MntFlags::MNT_FORCE);
    let _ = umount2(mountpoint, MntFlags::MNT_DETACH);
}
