//! Telemetry as datagrams: one JSON object after the other to one address, for plotting programs.

use crate::sampler::Sampler;
use std::io;
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr};
use std::rc::Rc;
use std::time::{Duration, SystemTime, UNIX_EPOCH};
use tokio::net::UdpSocket;

/// Sends for ever, every `period_ms`.
///
/// # Errors
/// There is no socket.
pub async fn send(sampler: Rc<Sampler>, to: SocketAddr, period_ms: u64) -> io::Result<()> {
    let any: IpAddr = if to.is_ipv4() {
        Ipv4Addr::UNSPECIFIED.into()
    } else {
        Ipv6Addr::UNSPECIFIED.into()
    };
    let socket = UdpSocket::bind((any, 0)).await?;
    let mut tick = tokio::time::interval(Duration::from_millis(period_ms));
    tick.set_missed_tick_behavior(tokio::time::MissedTickBehavior::Delay);
    loop {
        tick.tick().await;
        let snapshot = sampler.snapshot().await;
        let time_s = SystemTime::now()
            .duration_since(UNIX_EPOCH)
            .map_or(0.0, |time| time.as_secs_f64());
        // Nobody may be listening, or the network may be away.
        let _ = socket.send_to(snapshot.json(time_s).as_bytes(), to).await;
    }
}
