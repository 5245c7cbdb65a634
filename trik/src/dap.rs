//! `trik dap`: programs of blocks, in Python and in JavaScript in the debugger of an editor, by the Debug Adapter Protocol.
//!
//! Owns how a client comes: over standard input and output, or over TCP, one after the other, and `owner` whose it is there. `greeting` begins a talk, `session` is one, `client`
//! its frames, `launch` what it is about, `keys` how that is written, `points` its breakpoints, `view` what it sees of a program that is stopped. What is debugged is a target of
//! `debug`; a program in Python is debugged by debugpy, and `python` stands between that and the client; `script` is what JavaScript can.

mod client;
mod greeting;
mod keys;
mod launch;
mod owner;
mod points;
mod python;
mod script;
mod session;
mod view;
mod words;

use crate::refusal::{Refusal, UNREADABLE};
use clap::Args;
use client::Client;
use nix::unistd::getuid;
use owner::Owner;
use std::io::{self, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};

/// What `trik dap` can be told.
#[derive(Args, Clone, Debug)]
pub(crate) struct DapArgs {
    /// Serve clients on this TCP port, one after the other, instead of standard input and output; 0 is any free port. An
    /// address before it, as in 0.0.0.0:4711, lets other computers in, and with them everybody who can reach it; without one
    /// only programs of your own are let in.
    #[arg(long, value_name = "[ADDRESS:]PORT", value_parser = address)]
    pub listen: Option<SocketAddr>,
}

fn address(text: &str) -> Result<SocketAddr, String> {
    if let Ok(port) = text.parse::<u16>() {
        return Ok(SocketAddr::from(([127, 0, 0, 1], port)));
    }
    text.parse()
        .map_err(|_| "a port such as 4711 is wanted, or ADDRESS:PORT".to_owned())
}

/// Serves until the client has ended; over TCP until the process is ended.
///
/// # Errors
/// The port cannot be had.
pub(crate) fn run(args: &DapArgs) -> Result<u8, Refusal> {
    let Some(address) = args.listen else {
        // Standard output belongs to the protocol.
        greeting::serve(Client::new(io::stdin(), Box::new(io::stdout())));
        return Ok(0);
    };
    let failed = |why: io::Error| Refusal {
        code: UNREADABLE,
        ..Refusal::new(format!("{address}: {why}"))
    };
    let listener = TcpListener::bind(address).map_err(failed)?;
    let bound = listener.local_addr().map_err(failed)?;
    let _ = writeln!(io::stderr(), "trik dap: waiting on {bound}");
    loop {
        let (stream, peer) = listener.accept().map_err(failed)?;
        // A client can run programs as we do. An address for other computers lets everybody in.
        if bound.ip().is_loopback()
            && let Some(why) = why_not(peer, &stream)
        {
            let _ = writeln!(io::stderr(), "trik dap: {peer} {why}");
            continue;
        }
        let Ok(input) = stream.try_clone() else {
            continue;
        };
        // Small frames go at once.
        let _ = stream.set_nodelay(true);
        greeting::serve(Client::new(input, Box::new(stream)));
    }
}

/// Why a client of this computer is not served; none: it is a program of ours.
fn why_not(peer: SocketAddr, stream: &TcpStream) -> Option<&'static str> {
    let client = match stream.local_addr() {
        Ok(here) => owner::of(peer, here),
        Err(_) => Owner::Gone,
    };
    owner::why_not(client, getuid().as_raw())
}
