//! Which files a judged program reads and writes: rules of Landlock (Linux 5.13).
//!
//! Owns the list of what any Python needs of a computer. Newer kernels hold a program to more: no TCP, no signals to
//! others, no devices.

use super::inner::{Mounted, SCRATCH};
use super::order::Order;
use landlock::{
    ABI, Access, AccessFs, AccessNet, BitFlags, CompatLevel, Compatible, Ruleset, RulesetAttr,
    RulesetCreated, RulesetCreatedAttr, RulesetError, RulesetStatus, Scope, path_beneath_rules,
};

/// The newest rules that are asked for; what a kernel does not know of them it leaves out.
const NEWEST: ABI = ABI::V6;
/// Where libraries are, and what the C library reads. What is not there is passed by.
const SYSTEM: [&str; 9] = [
    "/usr",
    "/lib",
    "/lib32",
    "/lib64",
    "/nix/store",
    "/gnu/store",
    "/etc/ld.so.cache",
    "/etc/localtime",
    "/etc/ssl/openssl.cnf",
];
/// Devices that give bytes.
const SOURCES: [&str; 3] = ["/dev/zero", "/dev/urandom", "/dev/random"];
/// The device that takes everything.
const NULL: [&str; 1] = ["/dev/null"];
const PROC: [&str; 1] = ["/proc"];

/// Holds this process and all after it to the rules; whether the kernel does so.
pub(super) fn confine(order: &Order, mounted: &Mounted) -> bool {
    let restricted = rules(order, mounted).and_then(RulesetCreated::restrict_self);
    restricted.is_ok_and(|status| status.ruleset != RulesetStatus::NotEnforced)
}

fn rules(order: &Order, mounted: &Mounted) -> Result<RulesetCreated, RulesetError> {
    let runs: BitFlags<AccessFs> = AccessFs::from_read(NEWEST);
    let reads = AccessFs::ReadFile | AccessFs::ReadDir;
    let writes = AccessFs::ReadFile | AccessFs::WriteFile | AccessFs::Truncate;
    let mut rules = Ruleset::default()
        .set_compatibility(CompatLevel::BestEffort)
        .handle_access(AccessFs::from_all(NEWEST))?
        .handle_access(AccessNet::from_all(NEWEST))?
        .scope(Scope::from_all(NEWEST))?
        .create()?
        .add_rules(path_beneath_rules(SYSTEM, runs))?
        .add_rules(path_beneath_rules(order.program.first(), runs))?
        .add_rules(path_beneath_rules(&order.reads, runs))?
        .add_rules(path_beneath_rules(&order.folders, reads))?
        .add_rules(path_beneath_rules(SOURCES, AccessFs::ReadFile))?
        .add_rules(path_beneath_rules(NULL, writes))?;
    if mounted.has_proc {
        rules = rules.add_rules(path_beneath_rules(PROC, reads))?;
    }
    if mounted.has_scratch {
        let all = AccessFs::from_all(NEWEST) & !AccessFs::Execute;
        rules = rules.add_rules(path_beneath_rules([SCRATCH], all))?;
    }
    Ok(rules)
}
