//! Which system calls the process of an isolated converter may make: filters of seccomp (Linux 3.5), by lists of what is
//! allowed.
//!
//! Owns the lists and the filters made of them. A call that is in none fails with EPERM. `trik`'s sandbox of solutions lists
//! what is denied, because an interpreter needs most of a kernel; a converter needs nearly none of it.

use libc::c_long;
use seccompiler::{BpfProgram, apply_filter, sock_filter};

/// Which of the two filters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Stage {
    /// While libraries are loaded: files are opened, for reading only.
    Loading,
    /// From then on.
    Sealed,
}

/// Calls that are always allowed: waiting for the daemon, memory, time, and the own end. The first are asked most often.
const ALWAYS: &[c_long] = &[
    libc::SYS_futex,
    libc::SYS_read,
    libc::SYS_write,
    libc::SYS_clock_gettime,
    libc::SYS_clock_getres,
    libc::SYS_gettimeofday,
    libc::SYS_nanosleep,
    libc::SYS_clock_nanosleep,
    libc::SYS_restart_syscall,
    libc::SYS_brk,
    libc::SYS_munmap,
    libc::SYS_mremap,
    libc::SYS_mprotect,
    libc::SYS_madvise,
    libc::SYS_getrandom,
    libc::SYS_getpid,
    libc::SYS_getppid,
    libc::SYS_gettid,
    libc::SYS_sched_yield,
    libc::SYS_sched_getaffinity,
    libc::SYS_rt_sigaction,
    libc::SYS_rt_sigprocmask,
    libc::SYS_rt_sigreturn,
    libc::SYS_sigaltstack,
    libc::SYS_exit,
    libc::SYS_exit_group,
];
/// More of them, by the processor: where memory is mapped, and older or newer forms of the above.
#[cfg(target_arch = "x86_64")]
const ALWAYS_HERE: &[c_long] = &[libc::SYS_mmap, libc::SYS_time, libc::SYS_arch_prctl];
/// See above.
#[cfg(target_arch = "arm")]
const ALWAYS_HERE: &[c_long] = &[
    libc::SYS_mmap2,
    libc::SYS_sigreturn,
    // With times of 64 bits, and what only this processor has (asm/unistd.h): cacheflush, set_tls.
    403,
    407,
    422,
    0x000f_0002,
    0x000f_0005,
];
/// See above.
#[cfg(not(any(target_arch = "x86_64", target_arch = "arm")))]
const ALWAYS_HERE: &[c_long] = &[libc::SYS_mmap];
/// What the dynamic linker and constructors need as well, and what puts the second filter in force.
const LOADING: &[c_long] = &[
    libc::SYS_close,
    libc::SYS_fstat,
    libc::SYS_pread64,
    libc::SYS_readv,
    libc::SYS_getdents64,
    libc::SYS_lseek,
    libc::SYS_faccessat,
    libc::SYS_readlinkat,
    libc::SYS_getcwd,
    libc::SYS_uname,
    libc::SYS_statx,
    libc::SYS_seccomp,
    libc::SYS_getuid,
    libc::SYS_geteuid,
    libc::SYS_getgid,
    libc::SYS_getegid,
    libc::SYS_sysinfo,
];
/// See [`ALWAYS_HERE`].
#[cfg(target_arch = "x86_64")]
const LOADING_HERE: &[c_long] = &[
    libc::SYS_newfstatat,
    libc::SYS_stat,
    libc::SYS_lstat,
    libc::SYS_access,
    libc::SYS_readlink,
];
/// See above.
#[cfg(target_arch = "arm")]
const LOADING_HERE: &[c_long] = &[
    libc::SYS_fstat64,
    libc::SYS_fstatat64,
    libc::SYS_stat64,
    libc::SYS_lstat64,
    libc::SYS_access,
    libc::SYS_readlink,
    libc::SYS__llseek,
    libc::SYS_getuid32,
    libc::SYS_geteuid32,
    libc::SYS_getgid32,
    libc::SYS_getegid32,
];
/// See above.
#[cfg(not(any(target_arch = "x86_64", target_arch = "arm")))]
const LOADING_HERE: &[c_long] = &[libc::SYS_newfstatat];

/// How the kernel calls this processor in what a filter sees (linux/audit.h).
#[cfg(target_arch = "x86_64")]
const ARCHITECTURE: Option<u32> = Some(0xc000_003e);
/// See above.
#[cfg(target_arch = "aarch64")]
const ARCHITECTURE: Option<u32> = Some(0xc000_00b7);
/// See above.
#[cfg(target_arch = "arm")]
const ARCHITECTURE: Option<u32> = Some(0x4000_0028);
/// See above.
#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64", target_arch = "arm")))]
const ARCHITECTURE: Option<u32> = None;

/// Instructions of a filter (linux/bpf_common.h): load a word, keep some bits of it, jump if it is equal, give an answer.
const LOAD: u16 = 0x20;
const AND: u16 = 0x54;
const JUMP_EQUAL: u16 = 0x15;
const RETURN: u16 = 0x06;
/// Answers (linux/seccomp.h).
const ALLOW: u32 = 0x7fff_0000;
const KILL: u32 = 0x8000_0000;
/// The call fails with EPERM (asm-generic/errno-base.h).
const DENY: u32 = 0x0005_0000 | 1;
/// Where in what a filter sees (`struct seccomp_data`) the number of the call is, the processor, and the arguments, whose low
/// halves come first on all processors that this program knows.
const NUMBER_AT: u32 = 0;
const ARCHITECTURE_AT: u32 = 4;
const ARGUMENTS_AT: u32 = 16;
const ARGUMENT_BYTES: u32 = 8;

/// A call that is allowed if some bits of an argument are as wanted.
struct Guarded {
    call: c_long,
    argument: u32,
    bits: u32,
    wanted: u32,
}

/// Holds this process to a filter from here on; whether the kernel does so.
pub(super) fn confine(stage: Stage) -> bool {
    ARCHITECTURE.is_some_and(|architecture| {
        let program = filter(stage, architecture, std::process::id());
        apply_filter(&program).is_ok()
    })
}

fn filter(stage: Stage, architecture: u32, own: u32) -> BpfProgram {
    let instruction = |code, k, jt, jf| sock_filter { code, jt, jf, k };
    let answer = |k| instruction(RETURN, k, 0, 0);
    let mut program = vec![
        instruction(LOAD, ARCHITECTURE_AT, 0, 0),
        instruction(JUMP_EQUAL, architecture, 1, 0),
        answer(KILL),
        instruction(LOAD, NUMBER_AT, 0, 0),
    ];
    let (plain, guarded) = lists(stage, own);
    let number = |call: c_long| u32::try_from(call).unwrap_or(u32::MAX);
    for call in plain {
        program.push(instruction(JUMP_EQUAL, number(call), 0, 1));
        program.push(answer(ALLOW));
    }
    for one in guarded {
        program.extend([
            instruction(JUMP_EQUAL, number(one.call), 0, 5),
            instruction(LOAD, ARGUMENTS_AT + ARGUMENT_BYTES * one.argument, 0, 0),
            instruction(AND, one.bits, 0, 0),
            instruction(JUMP_EQUAL, one.wanted, 0, 1),
            answer(ALLOW),
            // Another entry may allow it for other reasons.
            instruction(LOAD, NUMBER_AT, 0, 0),
        ]);
    }
    program.push(answer(DENY));
    program
}

fn lists(stage: Stage, own: u32) -> (Vec<c_long>, Vec<Guarded>) {
    let mut plain = [ALWAYS, ALWAYS_HERE].concat();
    // abort(3) and raise(3) send signals to the caller itself.
    let to_itself = |call| Guarded {
        call,
        argument: 0,
        bits: u32::MAX,
        wanted: own,
    };
    let mut guarded = vec![to_itself(libc::SYS_tgkill), to_itself(libc::SYS_tkill)];
    match stage {
        Stage::Sealed => {}
        Stage::Loading => {
            plain.extend(LOADING);
            plain.extend(LOADING_HERE);
            let changes = libc::O_ACCMODE | libc::O_CREAT | libc::O_TRUNC;
            let reading = |call, argument| Guarded {
                call,
                argument,
                bits: changes.cast_unsigned(),
                wanted: 0,
            };
            guarded.push(reading(libc::SYS_openat, 2));
            #[cfg(any(target_arch = "x86_64", target_arch = "arm"))]
            guarded.push(reading(libc::SYS_open, 1));
            // What puts the second filter in force, and nothing that undoes the death with the daemon.
            guarded.extend(
                [libc::PR_SET_NO_NEW_PRIVS, libc::PR_SET_SECCOMP].map(|what| Guarded {
                    call: libc::SYS_prctl,
                    argument: 0,
                    bits: u32::MAX,
                    wanted: what.cast_unsigned(),
                }),
            );
        }
    }
    (plain, guarded)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Runs a filter over one call, as the kernel does.
    fn judged(stage: Stage, call: c_long, arguments: [u32; 6]) -> u32 {
        let architecture = ARCHITECTURE.unwrap();
        let program = filter(stage, architecture, 42);
        let mut seen = vec![u32::try_from(call).unwrap(), architecture, 0, 0];
        seen.extend(arguments.iter().flat_map(|low| [*low, 0]));
        let (mut at, mut word) = (0, 0);
        loop {
            let one = &program[at];
            at += 1;
            match one.code {
                LOAD => word = seen[one.k as usize / 4],
                AND => word &= one.k,
                JUMP_EQUAL => at += usize::from(if word == one.k { one.jt } else { one.jf }),
                RETURN => return one.k,
                code => panic!("instruction {code:#x}"),
            }
        }
    }

    #[test]
    fn a_converter_computes_and_ends_itself_and_does_nothing_else() {
        let none = [0; 6];
        for call in [libc::SYS_read, libc::SYS_exit_group, libc::SYS_munmap] {
            assert_eq!(judged(Stage::Sealed, call, none), ALLOW, "{call}");
        }
        let harmful = [
            libc::SYS_kill,
            libc::SYS_clone,
            libc::SYS_execve,
            libc::SYS_socket,
            libc::SYS_ptrace,
            libc::SYS_close,
            libc::SYS_openat,
            libc::SYS_unlinkat,
            libc::SYS_setrlimit,
        ];
        for call in harmful {
            assert_eq!(judged(Stage::Sealed, call, none), DENY, "{call}");
        }
        assert_eq!(
            judged(Stage::Sealed, libc::SYS_tgkill, [42, 1, 6, 0, 0, 0]),
            ALLOW
        );
        assert_eq!(
            judged(Stage::Sealed, libc::SYS_tgkill, [41, 1, 9, 0, 0, 0]),
            DENY
        );
    }

    #[test]
    fn while_libraries_are_loaded_files_are_read_and_not_changed() {
        let open = |flags: i32| {
            let flags = flags.cast_unsigned();
            judged(Stage::Loading, libc::SYS_openat, [0, 0, flags, 0, 0, 0])
        };
        assert_eq!(open(libc::O_RDONLY | libc::O_CLOEXEC), ALLOW);
        for flags in [
            libc::O_WRONLY,
            libc::O_RDWR,
            libc::O_CREAT,
            libc::O_TRUNC,
            libc::O_TMPFILE | libc::O_RDWR,
        ] {
            assert_eq!(open(flags), DENY, "{flags:#o}");
        }
        for call in [libc::SYS_clone, libc::SYS_fcntl] {
            assert_eq!(judged(Stage::Loading, call, [0; 6]), DENY, "{call}");
        }
        let control = |what: i32| {
            let what = what.cast_unsigned();
            judged(Stage::Loading, libc::SYS_prctl, [what, 0, 0, 0, 0, 0])
        };
        assert_eq!(control(libc::PR_SET_NO_NEW_PRIVS), ALLOW);
        assert_eq!(control(libc::PR_SET_SECCOMP), ALLOW);
        assert_eq!(control(libc::PR_SET_PDEATHSIG), DENY);
    }
}
