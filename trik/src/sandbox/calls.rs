//! Which system calls a judged program may not make: a filter of seccomp (Linux 3.5).
//!
//! Owns the list. It names what looks into others, what changes the computer, what makes memory that no limit counts,
//! what changes of files Landlock does not know, and what is new and large in kernels; all else is left to files, users
//! and namespaces.

use libc::c_long;
use seccompiler::{
    BackendError, BpfProgram, SeccompAction, SeccompCmpArgLen, SeccompCmpOp, SeccompCondition,
    SeccompFilter, SeccompRule, TargetArch, apply_filter, sock_filter,
};
use std::collections::BTreeMap;

/// Calls that fail with EPERM.
const DENIED: &[c_long] = &[
    // Other processes.
    libc::SYS_ptrace,
    libc::SYS_process_vm_readv,
    libc::SYS_process_vm_writev,
    libc::SYS_process_madvise,
    libc::SYS_pidfd_getfd,
    libc::SYS_kcmp,
    // What is mounted, and namespaces.
    libc::SYS_mount,
    libc::SYS_umount2,
    libc::SYS_pivot_root,
    libc::SYS_chroot,
    libc::SYS_move_mount,
    libc::SYS_open_tree,
    libc::SYS_fsopen,
    libc::SYS_fsconfig,
    libc::SYS_fsmount,
    libc::SYS_fspick,
    libc::SYS_mount_setattr,
    libc::SYS_unshare,
    libc::SYS_setns,
    // The network; the way to the judge is open already.
    libc::SYS_socket,
    // Doors of the kernel.
    libc::SYS_bpf,
    libc::SYS_perf_event_open,
    libc::SYS_userfaultfd,
    libc::SYS_io_uring_setup,
    libc::SYS_io_uring_enter,
    libc::SYS_io_uring_register,
    libc::SYS_io_setup,
    libc::SYS_fanotify_init,
    libc::SYS_add_key,
    libc::SYS_request_key,
    libc::SYS_keyctl,
    libc::SYS_name_to_handle_at,
    libc::SYS_open_by_handle_at,
    // The computer.
    libc::SYS_kexec_load,
    libc::SYS_init_module,
    libc::SYS_finit_module,
    libc::SYS_delete_module,
    libc::SYS_reboot,
    libc::SYS_swapon,
    libc::SYS_swapoff,
    libc::SYS_acct,
    libc::SYS_quotactl,
    libc::SYS_syslog,
    libc::SYS_sethostname,
    libc::SYS_setdomainname,
    libc::SYS_settimeofday,
    libc::SYS_clock_settime,
    libc::SYS_clock_adjtime,
    libc::SYS_adjtimex,
    libc::SYS_vhangup,
    libc::SYS_personality,
    // Memory that belongs to no process.
    libc::SYS_memfd_create,
    libc::SYS_memfd_secret,
    libc::SYS_shmget,
    libc::SYS_msgget,
    libc::SYS_semget,
    libc::SYS_mq_open,
    // What of files Landlock does not hold: rights, owners, times and notes of each file whose owner the program is, and
    // before Linux 6.2 how long a file is.
    libc::SYS_truncate,
    libc::SYS_fchmod,
    libc::SYS_fchmodat,
    FCHMODAT2,
    libc::SYS_fchown,
    libc::SYS_fchownat,
    libc::SYS_utimensat,
    libc::SYS_setxattr,
    libc::SYS_lsetxattr,
    libc::SYS_fsetxattr,
    SETXATTRAT,
    libc::SYS_removexattr,
    libc::SYS_lremovexattr,
    libc::SYS_fremovexattr,
    REMOVEXATTRAT,
    FILE_SETATTR,
];
/// Numbers that are the same on each processor, and that the crate has not for all of them.
const FCHMODAT2: c_long = 452;
/// See [`FCHMODAT2`].
const SETXATTRAT: c_long = 463;
/// See [`FCHMODAT2`].
const REMOVEXATTRAT: c_long = 466;
/// See [`FCHMODAT2`].
const FILE_SETATTR: c_long = 469;
/// More of them, where the processor has them.
#[cfg(target_arch = "x86_64")]
const DENIED_HERE: &[c_long] = &[
    libc::SYS_kexec_file_load,
    libc::SYS_iopl,
    libc::SYS_ioperm,
    libc::SYS_modify_ldt,
    // Older names of what changes files.
    libc::SYS_chmod,
    libc::SYS_chown,
    libc::SYS_lchown,
    libc::SYS_utime,
    libc::SYS_utimes,
    libc::SYS_futimesat,
];
#[cfg(not(target_arch = "x86_64"))]
const DENIED_HERE: &[c_long] = &[];
/// Calls that make a process.
#[cfg(target_arch = "x86_64")]
const FORKS: &[c_long] = &[libc::SYS_fork, libc::SYS_vfork];
#[cfg(not(target_arch = "x86_64"))]
const FORKS: &[c_long] = &[];
/// Which namespaces a new process may not have.
const NAMESPACES: [i32; 7] = [
    libc::CLONE_NEWNS,
    libc::CLONE_NEWCGROUP,
    libc::CLONE_NEWUTS,
    libc::CLONE_NEWIPC,
    libc::CLONE_NEWUSER,
    libc::CLONE_NEWPID,
    libc::CLONE_NEWNET,
];
/// Requests of ioctl that fail alike: what a file is besides its bytes (linux/fs.h), which Landlock does not know and a file
/// in memory has too, and what types into the terminal of somebody (linux/tty.h, older than Linux 6.2).
const REQUESTS: [u32; 5] = [
    // FS_IOC_SETFLAGS, and for programs of 32 bits.
    0x4008_6602,
    0x4004_6602,
    // FS_IOC_FSSETXATTR.
    0x401c_5820,
    // TIOCSTI, TIOCLINUX.
    0x5412,
    0x541c,
];
/// Which bits of the kind of a socket say what it is (linux/net.h).
const KINDS: u64 = 0xf;
/// Numbers from here on are calls of another kind of program on the same processor (x32), with lists of their own.
const OTHER_CALLS: u32 = 0x4000_0000;
/// Instructions of a filter (linux/bpf_common.h): load a word, jump if it is at least so great, give an answer.
const LOAD: u16 = 0x20;
const JUMP_GE: u16 = 0x35;
const RETURN: u16 = 0x06;

/// Holds this process and all after it to the filter; whether the kernel does so. If it is alone, it starts no other processes.
pub(super) fn confine(is_alone: bool) -> bool {
    let Ok(arch) = TargetArch::try_from(std::env::consts::ARCH) else {
        return false;
    };
    let not_there = SeccompAction::Errno(libc::ENOSYS as u32);
    let denied = SeccompAction::Errno(libc::EPERM as u32);
    // Its flags are in memory, where a filter cannot look; the C library takes clone instead.
    let clone3 = BTreeMap::from([(libc::SYS_clone3, Vec::new())]);
    let put = |rules, action| {
        let filter = SeccompFilter::new(rules, SeccompAction::Allow, action, arch)?;
        BpfProgram::try_from(filter)
    };
    let both = || -> Result<[BpfProgram; 2], BackendError> {
        let mut first = foreign();
        first.extend(put(clone3, not_there)?);
        Ok([first, put(rules(is_alone)?, denied)?])
    };
    both().is_ok_and(|filters| filters.iter().all(|one| apply_filter(one).is_ok()))
}

/// Refuses calls of other kinds of programs.
fn foreign() -> BpfProgram {
    let statement = |code, k| sock_filter {
        code,
        jt: 0,
        jf: 0,
        k,
    };
    let answer = u32::from(SeccompAction::Errno(libc::ENOSYS as u32));
    vec![
        statement(LOAD, 0),
        sock_filter {
            jf: 1,
            ..statement(JUMP_GE, OTHER_CALLS)
        },
        statement(RETURN, answer),
    ]
}

fn rules(is_alone: bool) -> Result<BTreeMap<i64, Vec<SeccompRule>>, BackendError> {
    let all = DENIED.iter().chain(DENIED_HERE);
    let mut rules: BTreeMap<i64, Vec<SeccompRule>> = all.map(|call| (*call, Vec::new())).collect();
    let when = |argument, compare, value| {
        let length = SeccompCmpArgLen::Dword;
        SeccompRule::new(vec![SeccompCondition::new(
            argument, length, compare, value,
        )?])
    };
    let flag = |flag: i32, is_set: bool| {
        let mask = u64::from(flag.cast_unsigned());
        when(
            0,
            SeccompCmpOp::MaskedEq(mask),
            if is_set { mask } else { 0 },
        )
    };
    let mut clone = Vec::new();
    for namespace in NAMESPACES {
        clone.push(flag(namespace, true)?);
    }
    if is_alone {
        clone.push(flag(libc::CLONE_THREAD, false)?);
        rules.extend(FORKS.iter().map(|call| (*call, Vec::new())));
    }
    rules.insert(libc::SYS_clone, clone);
    // Pairs of streams go nowhere; with one of another kind each socket of the computer that has a path could be told
    // something.
    let local = u64::from(libc::AF_UNIX.cast_unsigned());
    let stream = u64::from(libc::SOCK_STREAM.cast_unsigned());
    let mut pairs = vec![when(0, SeccompCmpOp::Ne, local)?];
    for kind in (0..=KINDS).filter(|kind| *kind != stream) {
        pairs.push(when(1, SeccompCmpOp::MaskedEq(KINDS), kind)?);
    }
    rules.insert(libc::SYS_socketpair, pairs);
    let mut requests = Vec::new();
    for request in REQUESTS {
        // The kernel takes 32 bits of it.
        requests.push(when(1, SeccompCmpOp::Eq, request.into())?);
    }
    rules.insert(libc::SYS_ioctl, requests);
    // A program that dies with the judge must not change that.
    let death = u64::from(libc::PR_SET_PDEATHSIG.cast_unsigned());
    rules.insert(libc::SYS_prctl, vec![when(0, SeccompCmpOp::Eq, death)?]);
    Ok(rules)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Most of these fail for an unprivileged user without any filter too, so a program cannot test the filter.
    #[test]
    fn each_call_that_is_named_has_a_rule() {
        let whole = rules(false).unwrap();
        let always = [
            libc::SYS_mount,
            libc::SYS_umount2,
            libc::SYS_pivot_root,
            libc::SYS_chroot,
            libc::SYS_unshare,
            libc::SYS_setns,
            libc::SYS_socket,
            libc::SYS_bpf,
            libc::SYS_perf_event_open,
            libc::SYS_keyctl,
            libc::SYS_userfaultfd,
            libc::SYS_io_uring_setup,
            libc::SYS_kexec_load,
            libc::SYS_ptrace,
            libc::SYS_process_vm_readv,
            libc::SYS_process_vm_writev,
            libc::SYS_pidfd_getfd,
            libc::SYS_memfd_create,
            libc::SYS_shmget,
            libc::SYS_mq_open,
            libc::SYS_truncate,
            libc::SYS_fchmod,
            libc::SYS_fchmodat,
            452,
            libc::SYS_fchown,
            libc::SYS_fchownat,
            libc::SYS_utimensat,
            libc::SYS_setxattr,
            libc::SYS_lsetxattr,
            libc::SYS_fsetxattr,
            libc::SYS_removexattr,
            libc::SYS_lremovexattr,
            libc::SYS_fremovexattr,
        ];
        for call in always {
            // Without a condition: always.
            assert!(whole.get(&call).is_some_and(Vec::is_empty), "{call}");
        }
        for call in [
            libc::SYS_clone,
            libc::SYS_socketpair,
            libc::SYS_ioctl,
            libc::SYS_prctl,
        ] {
            assert!(!whole[&call].is_empty(), "{call}");
        }
        #[cfg(target_arch = "x86_64")]
        for call in [
            libc::SYS_chmod,
            libc::SYS_chown,
            libc::SYS_lchown,
            libc::SYS_utime,
            libc::SYS_utimes,
            libc::SYS_futimesat,
        ] {
            assert!(whole.get(&call).is_some_and(Vec::is_empty), "{call}");
        }
        let alone = rules(true).unwrap();
        assert_eq!(alone[&libc::SYS_clone].len(), NAMESPACES.len() + 1);
        assert!(FORKS.iter().all(|call| alone.contains_key(call)));
    }
}
