//! `mount` and its hidden other half `serve`: the processes around one mounted tree.
//!
//! Foreground: this process becomes the guardian, which starts `serve`. Background: this process starts a guardian in a
//! session of its own, waits for its one line, and ends. Owns that line and what becomes of a terminal; `guardian` and
//! `daemon` do the work.

use super::{MountArgs, ServeArgs, absolute, notify};
use crate::convert::shared::copies;
use crate::daemon::{self, InForce, Options};
use crate::failure::Failure;
use crate::guardian::inherit::{Farewell, Inheritance};
use crate::guardian::ledger::Ledger;
use crate::guardian::{self, Plan};
use crate::limits::READY_LINE_BYTES_MAX;
use crate::mount::MountOptions;
use crate::sample_bus::Readers;
use crate::tree::Owner;
use nix::sys::prctl;
use nix::sys::stat::{SFlag, fstat};
use nix::unistd::{dup2_stderr, dup2_stdout, getgid, getuid, setsid};
use std::ffi::OsString;
use std::fs::File;
use std::io::{self, Read, Write};
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::{Command, Stdio};

/// `trikfs mount`.
pub(super) fn mount(args: MountArgs) -> Result<(), Failure> {
    let args = MountArgs {
        tree: args.tree.absolute()?,
        mountpoint: absolute(&args.mountpoint)?,
        ..args
    };
    if args.tree.group.is_some() && !args.allow_other {
        let reason =
            "--group is for other users, who are only let in with --allow-other: give both";
        return Err(Failure::Refused(reason.to_owned()));
    }
    make_mountpoint(&args.mountpoint)?;
    if args.background && !args.detached {
        start_in_background(&args)
    } else {
        guard(&args)
    }
}

/// Started through /proc/self/exe this process would be listed as `exe`.
fn name_process() {
    let _ = prctl::set_name(c"trikfs");
}

/// Creates the directory if it does not exist; it stays when the tree is gone.
fn make_mountpoint(path: &Path) -> Result<(), Failure> {
    // Anything else than "not there" (a stale mount, no permission) is the mounting's to tell.
    if matches!(path.symlink_metadata(), Err(error) if error.kind() == io::ErrorKind::NotFound) {
        std::fs::create_dir_all(path).map_err(|error| {
            let what = format!("the mount point {} cannot be made", path.display());
            Failure::system(what, error)
        })?;
    }
    Ok(())
}

/// Starts this program again, detached, and passes on the line with which it says that the tree can be used.
fn start_in_background(args: &MountArgs) -> Result<(), Failure> {
    let fail = |error: io::Error| Failure::system("starting in the background", error);
    let (line, writer) = io::pipe().map_err(fail)?;
    let mut command = Command::new("/proc/self/exe");
    command
        .arg0("trikfs")
        .args(["mount", "--background", "--detached"])
        .args(args.tree.to_arguments())
        .args(args.allow_other.then_some("--allow-other"))
        .arg("--")
        .arg(&args.mountpoint)
        .stdin(Stdio::null())
        .stdout(writer);
    let mut guardian = command.spawn().map_err(fail)?;
    // The command holds our copy of the writing end, and the line ends when the guardian closes its own.
    drop(command);
    let mut said = Vec::new();
    line.take(READY_LINE_BYTES_MAX)
        .read_to_end(&mut said)
        .map_err(fail)?;
    if said.ends_with(b"\n") {
        return super::print(&said);
    }
    let status = guardian.wait().map_err(fail)?;
    // An exit is a refusal, for which there are words on standard error.
    match status.code() {
        Some(_) => Err(Failure::Reported),
        None => Err(Failure::system("starting in the background", status)),
    }
}

/// Guards the tree until it is stopped.
fn guard(args: &MountArgs) -> Result<(), Failure> {
    name_process();
    if args.detached {
        // Fails only for the leader of a session, which has what this is for.
        let _ = setsid();
        // A daemon must not keep a file system busy that somebody wants to unmount.
        std::env::set_current_dir("/").map_err(|error| Failure::file(Path::new("/"), error))?;
    }
    let mut arguments: Vec<OsString> = args.tree.to_arguments();
    arguments.extend(args.detached.then(|| "--detached".into()));
    arguments.extend(args.allow_other.then(|| "--allow-other".into()));
    let plan = Plan {
        mountpoint: args.mountpoint.clone(),
        mount: MountOptions {
            allow_other: args.allow_other,
            ..MountOptions::default()
        },
        arguments,
    };
    let mut announced = false;
    let mut ready = |nodes: usize| {
        if announced {
            let _ = writeln!(
                io::stderr(),
                "trikfs: serving {} again ({})",
                args.mountpoint.display(),
                count(nodes)
            );
            return;
        }
        announced = true;
        // The process that started this one may not listen; the tree can be used all the same.
        let _ = writeln!(io::stdout(), "{}", ready_line(&args.mountpoint, nodes))
            .and_then(|()| io::stdout().flush());
        notify::ready();
        if args.detached {
            detach_output();
        }
    };
    guardian::run(&plan, &mut ready)
}

fn ready_line(mountpoint: &Path, nodes: usize) -> String {
    let shown = mountpoint.display();
    format!(
        "trikfs: ready on {shown} ({}); try: cat {}",
        count(nodes),
        mountpoint.join("status").display()
    )
}

fn count(nodes: usize) -> String {
    match nodes {
        1 => "1 node".to_owned(),
        _ => format!("{nodes} nodes"),
    }
}

/// Closes a terminal or pipe, so that no program waits for its end or gets text from a process long forgotten.
/// Messages still go to a regular file, because they were directed there on purpose.
fn detach_output() {
    let Ok(nowhere) = File::options().write(true).open("/dev/null") else {
        return;
    };
    let _ = dup2_stdout(&nowhere);
    let kept = fstat(io::stderr()).is_ok_and(|found| {
        SFlag::from_bits_truncate(found.st_mode) & SFlag::S_IFMT == SFlag::S_IFREG
    });
    if !kept {
        let _ = dup2_stderr(&nowhere);
    }
}

/// `trikfs serve`: the daemon, as its guardian starts it.
pub(super) fn serve(args: ServeArgs) -> Result<(), Failure> {
    name_process();
    let inheritance = Inheritance::take(&args.handover)?;
    let fail = |error: io::Error| Failure::system("serve", error);
    let farewell =
        Farewell::prepare(&inheritance, &args.mountpoint, &args.handover).map_err(fail)?;
    let lifeline = inheritance.lifeline.clone();
    let paths = args.tree.search.paths()?;
    let detached = args.detached;
    let again = args.handover.again;
    let result = daemon::run(Options {
        device: inheritance.device,
        mountpoint: args.mountpoint,
        config: args.tree.config,
        in_force: again.then(|| in_force(&inheritance.ledger)).flatten(),
        include_dirs: paths.include_dirs,
        library_dirs: paths.library_dirs,
        device_root: paths.device_root,
        cache: paths.cache,
        owner: Owner {
            uid: getuid().as_raw(),
            gid: getgid().as_raw(),
            config_group: args.tree.config_group,
            group: args.tree.group,
        },
        transport: args.tree.transport.transport(),
        sample_bus: (!args.tree.no_sample_bus).then_some(match args.allow_other {
            true => Readers::All,
            false => Readers::Owner,
        }),
        raw: args.tree.raw,
        ledger: Some(inheritance.ledger),
        ready: Box::new(move |nodes| {
            if detached {
                // Before the guardian hears of it: the line must come after the last copy of the terminal is closed.
                detach_output();
            }
            lifeline.ready(nodes);
        }),
        progress: Box::new(super::progress),
    });
    // After a failure in the middle the guardian shall start another daemon.
    if result.is_ok() {
        inheritance.lifeline.over();
    }
    farewell.say();
    drop(inheritance.lifeline);
    result
}

/// What the daemon before this one had in force.
fn in_force(ledger: &Ledger) -> Option<InForce> {
    Some(InForce {
        config: ledger.config()?,
        copies: copies::decode(&ledger.copies()),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_line_says_where_how_many_and_what_to_try() {
        assert_eq!(
            ready_line(Path::new("/tmp/trikfs"), 6),
            "trikfs: ready on /tmp/trikfs (6 nodes); try: cat /tmp/trikfs/status"
        );
        assert!(ready_line(Path::new("/t"), 1).contains("(1 node)"));
    }
}
