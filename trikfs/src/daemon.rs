//! The process that serves one mount, from its first configuration to its end.
//!
//! Owns the order of things: serving starts before the configuration runs, which may take long when it compiles C;
//! actuators come to rest before the process ends. The guardian, which is another process, mounts before and unmounts after.
//! Knows no request of the kernel and no kind of device.

use crate::admission::Admission;
use crate::convert::shared::Cache;
use crate::convert::shared::copies::CopyNames;
use crate::engine::Engine;
use crate::errno::Error;
use crate::failure::Failure;
use crate::fs::{Forest, Fs, OpenFiles};
use crate::guardian::ledger::Ledger;
use crate::guardian::oversight::Oversight;
use crate::memory;
use crate::node::{Node, rest_all};
use crate::reload::{Reloader, Setup};
use crate::sample_bus::Readers;
use crate::transport::Operations;
use crate::tree::{Owner, Tree};
use config::load::Loader;
use nix::sys::resource::{Resource, getrlimit, setrlimit};
use nix::sys::signal::{SigSet, Signal};
use nix::unistd::getppid;
use std::os::fd::OwnedFd;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Sender, channel};

/// Which transport serves the kernel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Transport {
    /// Our own layer over /dev/fuse.
    #[default]
    Native,
    /// The fuser crate.
    #[cfg(feature = "fuser")]
    Fuser,
}

/// A configuration that was in force.
pub struct InForce {
    /// Its bytes.
    pub config: Vec<u8>,
    /// The copies of its libraries.
    pub copies: CopyNames,
}

/// What the process is started with.
pub struct Options {
    /// The mounted /dev/fuse.
    pub device: OwnedFd,
    /// Where it is mounted, for messages.
    pub mountpoint: PathBuf,
    /// The configuration file; an empty tree without one.
    pub config: Option<PathBuf>,
    /// What was in force before a crash; it takes the place of the file.
    pub in_force: Option<InForce>,
    /// Where `include` looks.
    pub include_dirs: Vec<PathBuf>,
    /// Where shared libraries are looked for after the configuration's directory.
    pub library_dirs: Vec<PathBuf>,
    /// Below which all device paths are taken.
    pub device_root: Option<PathBuf>,
    /// Compiled converters.
    pub cache: Cache,
    /// Owner of the tree.
    pub owner: Owner,
    /// Which transport serves the kernel.
    pub transport: Transport,
    /// Who may read the samples in shared memory; None: there are none.
    pub sample_bus: Option<Readers>,
    /// They have what devices give before it is converted, of every node.
    pub raw: bool,
    /// What the guardian must know.
    pub ledger: Option<Ledger>,
    /// Called when the first configuration is in force, with its number of nodes.
    pub ready: Box<dyn FnOnce(usize)>,
    /// Told before something that takes long.
    pub progress: Box<dyn Fn(&str)>,
}

enum End {
    Signal,
    Unmounted,
    Failed(Failure),
}

/// Serves until a signal asks to stop or the mount is gone. An error is a refused configuration or a failure.
pub fn run(options: Options) -> Result<(), Failure> {
    let signals = block_signals()?;
    config::program::keep_memory_together();
    raise_file_limit();
    let engine = Engine::start().map_err(|error| Failure::threads(&error))?;
    engine.panics.listen();
    let (end, ended) = channel();
    wait_for_signals(signals, end.clone())?;

    let mut last_ino = crate::tree::ROOT;
    let forest = Arc::new(Forest::new(Tree::build(
        Vec::new(),
        &[],
        options.owner,
        None,
        &mut last_ino,
    )));
    oversee(&engine, &forest);
    let files = Arc::new(OpenFiles::default());
    let setup = Setup {
        engine: engine.clone(),
        forest: forest.clone(),
        files: files.clone(),
        loader: Loader {
            include_dirs: options.include_dirs,
            library_dirs: options.library_dirs,
            device_root: options.device_root,
        },
        base_dir: base_dir(options.config.as_deref()),
        cache: options.cache,
        promised: promised(options.in_force.as_ref()),
        owner: options.owner,
        last_ino,
        ledger: options.ledger,
    };
    let reloader = Reloader::start(setup).map_err(|error| Failure::threads(&error))?;
    let fs: Arc<dyn Operations> = Arc::new(Fs::new(
        engine.clone(),
        forest.clone(),
        files,
        Admission::new(options.owner.uid, memory::bytes()),
        reloader.clone(),
    ));
    serve(options.device, fs, options.transport, end)?;
    engine
        .log
        .line(&format!("mounted on {}", options.mountpoint.display()));

    engine.samples.set_raw(options.raw);
    engine.open_sample_bus(&options.mountpoint, options.sample_bus);
    let loaded = first_configuration(options.config.as_deref(), options.in_force);
    let applied = loaded.and_then(|(name, bytes)| {
        let applied = reloader.apply(&name, bytes, &options.progress);
        applied.map_err(Failure::Problem)
    });
    let outcome = match applied {
        Err(reason) => Err(reason),
        Ok(nodes) => {
            (options.ready)(nodes);
            match ended.recv() {
                Ok(End::Signal | End::Unmounted) | Err(_) => Ok(()),
                Ok(End::Failed(reason)) => Err(reason),
            }
        }
    };
    if let Err(error) = rest_all(forest.tree().nodes()) {
        eprintln!("trikfs: an actuator could not be brought to rest: {error}");
    }
    leave_bus(&engine, forest.tree().nodes());
    engine.refuse_all(&Error::ShuttingDown);
    engine.stop();
    outcome
}

/// Where relative paths of a configuration start.
fn base_dir(config: Option<&Path>) -> Option<PathBuf> {
    config.and_then(Path::parent).map(Path::to_path_buf)
}

fn promised(in_force: Option<&InForce>) -> CopyNames {
    in_force.map_or_else(CopyNames::new, |in_force| in_force.copies.clone())
}

/// Has the guardian, which is the parent, looked at while actuators are driven.
fn oversee(engine: &Arc<Engine>, forest: &Arc<Forest>) {
    let forest = forest.clone();
    let guardian = getppid().as_raw().unsigned_abs();
    let nodes = Box::new(move || forest.tree().nodes().to_vec());
    let oversight = Oversight::new(guardian, engine, nodes);
    engine.on_driven(Box::new(move || oversight.driven()));
}

/// Readers of shared memory see the end, even of nodes that something still holds.
fn leave_bus(engine: &Engine, nodes: &[Arc<Node>]) {
    for node in nodes {
        node.sampling.newest.leave_bus();
    }
    engine.samples.close();
}

/// Every thread started from here on leaves these signals to the one that waits for them.
fn block_signals() -> Result<SigSet, Failure> {
    let mut signals = SigSet::empty();
    for signal in [Signal::SIGTERM, Signal::SIGINT, Signal::SIGHUP] {
        signals.add(signal);
    }
    let blocked = signals.thread_block();
    blocked.map_err(|errno| Failure::system("signals cannot be blocked", errno))?;
    Ok(signals)
}

/// Every open file of a character device is one of ours as well: take as many descriptors as we may have.
fn raise_file_limit() {
    if let Ok((_, most)) = getrlimit(Resource::RLIMIT_NOFILE) {
        // With fewer, opening fails with EMFILE sooner.
        let _ = setrlimit(Resource::RLIMIT_NOFILE, most, most);
    }
}

/// The name and bytes of the configuration to begin with.
fn first_configuration(
    file: Option<&Path>,
    in_force: Option<InForce>,
) -> Result<(String, Vec<u8>), Failure> {
    let name = file.map_or_else(|| "config".to_owned(), |file| file.display().to_string());
    if let Some(in_force) = in_force {
        return Ok((name, in_force.config));
    }
    let Some(file) = file else {
        return Ok((name, b"trikfs = {}\n".to_vec()));
    };
    let bytes = crate::check::read_config(file).map_err(|error| Failure::file(file, error))?;
    Ok((name, bytes))
}

fn wait_for_signals(signals: SigSet, end: Sender<End>) -> Result<(), Failure> {
    let thread = std::thread::Builder::new().name("signals".to_owned());
    let spawned = thread.spawn(move || {
        if signals.wait().is_ok() {
            let _ = end.send(End::Signal);
        }
    });
    spawned
        .map(|_| ())
        .map_err(|error| Failure::threads(&error))
}

fn serve(
    device: OwnedFd,
    fs: Arc<dyn Operations>,
    transport: Transport,
    end: Sender<End>,
) -> Result<(), Failure> {
    let thread = std::thread::Builder::new().name("kernel".to_owned());
    let spawned = thread.spawn(move || {
        let serve = || match transport {
            Transport::Native => crate::transport::native::serve(device, fs),
            #[cfg(feature = "fuser")]
            Transport::Fuser => crate::transport::fuser::serve(device, fs),
        };
        let what = "the kernel cannot be served";
        // Without this thread nobody would be served, and nobody would know: another daemon has to be started.
        let _ = end.send(match catch_unwind(AssertUnwindSafe(serve)) {
            Ok(Ok(())) => End::Unmounted,
            Ok(Err(error)) => End::Failed(Failure::system(what, error)),
            Err(_) => End::Failed(Failure::system(what, "a panic, which was told above")),
        });
    });
    spawned
        .map(|_| ())
        .map_err(|error| Failure::threads(&error))
}
