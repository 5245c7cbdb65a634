//! Names that the headers of generated C declare: functions, types, macros.
//!
//! Owns a list, made from what gcc 12 and glibc 2.36 say of these headers (`cc -dM -E`, `cc -E -P`), without names that
//! begin with an underscore. A pupil's variable may well be called `remainder`.

/// The names, with spaces between.
pub(super) const TAKEN: &str = "\
    ADJ_ESTERROR ADJ_FREQUENCY ADJ_MAXERROR ADJ_MICRO ADJ_NANO ADJ_OFFSET ADJ_OFFSET_SINGLESHOT ADJ_OFFSET_SS_READ \
    ADJ_SETOFFSET ADJ_STATUS ADJ_TAI ADJ_TICK ADJ_TIMECONST AT_EACCESS AT_EMPTY_PATH AT_FDCWD AT_NO_AUTOMOUNT \
    AT_RECURSIVE AT_REMOVEDIR AT_STATX_DONT_SYNC AT_STATX_FORCE_SYNC AT_STATX_SYNC_AS_STAT AT_STATX_SYNC_TYPE \
    AT_SYMLINK_FOLLOW AT_SYMLINK_NOFOLLOW BIG_ENDIAN BUFSIZ BYTE_ORDER CLOCKS_PER_SEC CLOCK_BOOTTIME \
    CLOCK_BOOTTIME_ALARM CLOCK_MONOTONIC CLOCK_MONOTONIC_COARSE CLOCK_MONOTONIC_RAW CLOCK_PROCESS_CPUTIME_ID \
    CLOCK_REALTIME CLOCK_REALTIME_ALARM CLOCK_REALTIME_COARSE CLOCK_TAI CLOCK_THREAD_CPUTIME_ID CLONE_CHILD_CLEARTID \
    CLONE_CHILD_SETTID CLONE_DETACHED CLONE_FILES CLONE_FS CLONE_IO CLONE_NEWCGROUP CLONE_NEWIPC CLONE_NEWNET \
    CLONE_NEWNS CLONE_NEWPID CLONE_NEWTIME CLONE_NEWUSER CLONE_NEWUTS CLONE_PARENT CLONE_PARENT_SETTID CLONE_PIDFD \
    CLONE_PTRACE CLONE_SETTLS CLONE_SIGHAND CLONE_SYSVSEM CLONE_THREAD CLONE_UNTRACED CLONE_VFORK CLONE_VM \
    CLOSE_RANGE_CLOEXEC CLOSE_RANGE_UNSHARE CPU_ALLOC CPU_ALLOC_SIZE CPU_AND CPU_AND_S CPU_CLR CPU_CLR_S CPU_COUNT \
    CPU_COUNT_S CPU_EQUAL CPU_EQUAL_S CPU_FREE CPU_ISSET CPU_ISSET_S CPU_OR CPU_OR_S CPU_SET CPU_SETSIZE CPU_SET_S \
    CPU_XOR CPU_XOR_S CPU_ZERO CPU_ZERO_S CSIGNAL DN_ACCESS DN_ATTRIB DN_CREATE DN_DELETE DN_MODIFY DN_MULTISHOT \
    DN_RENAME E2BIG EACCES EADDRINUSE EADDRNOTAVAIL EADV EAFNOSUPPORT EAGAIN EALREADY EBADE EBADF EBADFD EBADMSG \
    EBADR EBADRQC EBADSLT EBFONT EBUSY ECANCELED ECHILD ECHRNG ECOMM ECONNABORTED ECONNREFUSED ECONNRESET EDEADLK \
    EDEADLOCK EDESTADDRREQ EDOM EDOTDOT EDQUOT EEXIST EFAULT EFBIG EHOSTDOWN EHOSTUNREACH EHWPOISON EIDRM EILSEQ \
    EINPROGRESS EINTR EINVAL EIO EISCONN EISDIR EISNAM EKEYEXPIRED EKEYREJECTED EKEYREVOKED EL2HLT EL2NSYNC EL3HLT \
    EL3RST ELIBACC ELIBBAD ELIBEXEC ELIBMAX ELIBSCN ELNRNG ELOOP EMEDIUMTYPE EMFILE EMLINK EMSGSIZE EMULTIHOP \
    ENAMETOOLONG ENAVAIL ENETDOWN ENETRESET ENETUNREACH ENFILE ENOANO ENOBUFS ENOCSI ENODATA ENODEV ENOENT ENOEXEC \
    ENOKEY ENOLCK ENOLINK ENOMEDIUM ENOMEM ENOMSG ENONET ENOPKG ENOPROTOOPT ENOSPC ENOSR ENOSTR ENOSYS ENOTBLK \
    ENOTCONN ENOTDIR ENOTEMPTY ENOTNAM ENOTRECOVERABLE ENOTSOCK ENOTSUP ENOTTY ENOTUNIQ ENXIO EOF EOPNOTSUPP \
    EOVERFLOW EOWNERDEAD EPERM EPFNOSUPPORT EPIPE EPROTO EPROTONOSUPPORT EPROTOTYPE ERANGE EREMCHG EREMOTE EREMOTEIO \
    ERESTART ERFKILL EROFS ESHUTDOWN ESOCKTNOSUPPORT ESPIPE ESRCH ESRMNT ESTALE ESTRPIPE ETIME ETIMEDOUT \
    ETOOMANYREFS ETXTBSY EUCLEAN EUNATCH EUSERS EWOULDBLOCK EXDEV EXFULL EXIT_FAILURE EXIT_SUCCESS \
    FALLOC_FL_COLLAPSE_RANGE FALLOC_FL_INSERT_RANGE FALLOC_FL_KEEP_SIZE FALLOC_FL_NO_HIDE_STALE FALLOC_FL_PUNCH_HOLE \
    FALLOC_FL_UNSHARE_RANGE FALLOC_FL_ZERO_RANGE FAPPEND FASYNC FD_CLOEXEC FD_CLR FD_ISSET FD_SET FD_SETSIZE FD_ZERO \
    FFSYNC FILE FILENAME_MAX FNDELAY FNONBLOCK FOPEN_MAX FP_ILOGB0 FP_ILOGBNAN FP_INFINITE FP_INT_DOWNWARD \
    FP_INT_TONEAREST FP_INT_TONEARESTFROMZERO FP_INT_TOWARDZERO FP_INT_UPWARD FP_LLOGB0 FP_LLOGBNAN FP_NAN FP_NORMAL \
    FP_SUBNORMAL FP_ZERO F_ADD_SEALS F_DUPFD F_DUPFD_CLOEXEC F_EXLCK F_GETFD F_GETFL F_GETLEASE F_GETLK F_GETLK64 \
    F_GETOWN F_GETOWN_EX F_GETPIPE_SZ F_GETSIG F_GET_FILE_RW_HINT F_GET_RW_HINT F_GET_SEALS F_LOCK F_NOTIFY \
    F_OFD_GETLK F_OFD_SETLK F_OFD_SETLKW F_OK F_OWNER_GID F_OWNER_PGRP F_OWNER_PID F_OWNER_TID F_RDLCK \
    F_SEAL_FUTURE_WRITE F_SEAL_GROW F_SEAL_SEAL F_SEAL_SHRINK F_SEAL_WRITE F_SETFD F_SETFL F_SETLEASE F_SETLK \
    F_SETLK64 F_SETLKW F_SETLKW64 F_SETOWN F_SETOWN_EX F_SETPIPE_SZ F_SETSIG F_SET_FILE_RW_HINT F_SET_RW_HINT \
    F_SHLCK F_TEST F_TLOCK F_ULOCK F_UNLCK F_WRLCK HUGE_VAL HUGE_VALF HUGE_VALL HUGE_VAL_F128 HUGE_VAL_F32 \
    HUGE_VAL_F32X HUGE_VAL_F64 HUGE_VAL_F64X INFINITY LITTLE_ENDIAN LOCK_EX LOCK_MAND LOCK_NB LOCK_READ LOCK_RW \
    LOCK_SH LOCK_UN LOCK_WRITE L_INCR L_SET L_XTND L_ctermid L_cuserid L_tmpnam MATH_ERREXCEPT MATH_ERRNO MAXFLOAT \
    MAX_HANDLE_SZ MB_CUR_MAX MOD_CLKA MOD_CLKB MOD_ESTERROR MOD_FREQUENCY MOD_MAXERROR MOD_MICRO MOD_NANO MOD_OFFSET \
    MOD_STATUS MOD_TAI MOD_TIMECONST M_1_PI M_1_PIf M_1_PIf128 M_1_PIf32 M_1_PIf32x M_1_PIf64 M_1_PIf64x M_1_PIl \
    M_2_PI M_2_PIf M_2_PIf128 M_2_PIf32 M_2_PIf32x M_2_PIf64 M_2_PIf64x M_2_PIl M_2_SQRTPI M_2_SQRTPIf \
    M_2_SQRTPIf128 M_2_SQRTPIf32 M_2_SQRTPIf32x M_2_SQRTPIf64 M_2_SQRTPIf64x M_2_SQRTPIl M_E M_Ef M_Ef128 M_Ef32 \
    M_Ef32x M_Ef64 M_Ef64x M_El M_LN10 M_LN10f M_LN10f128 M_LN10f32 M_LN10f32x M_LN10f64 M_LN10f64x M_LN10l M_LN2 \
    M_LN2f M_LN2f128 M_LN2f32 M_LN2f32x M_LN2f64 M_LN2f64x M_LN2l M_LOG10E M_LOG10Ef M_LOG10Ef128 M_LOG10Ef32 \
    M_LOG10Ef32x M_LOG10Ef64 M_LOG10Ef64x M_LOG10El M_LOG2E M_LOG2Ef M_LOG2Ef128 M_LOG2Ef32 M_LOG2Ef32x M_LOG2Ef64 \
    M_LOG2Ef64x M_LOG2El M_PI M_PI_2 M_PI_2f M_PI_2f128 M_PI_2f32 M_PI_2f32x M_PI_2f64 M_PI_2f64x M_PI_2l M_PI_4 \
    M_PI_4f M_PI_4f128 M_PI_4f32 M_PI_4f32x M_PI_4f64 M_PI_4f64x M_PI_4l M_PIf M_PIf128 M_PIf32 M_PIf32x M_PIf64 \
    M_PIf64x M_PIl M_SQRT1_2 M_SQRT1_2f M_SQRT1_2f128 M_SQRT1_2f32 M_SQRT1_2f32x M_SQRT1_2f64 M_SQRT1_2f64x \
    M_SQRT1_2l M_SQRT2 M_SQRT2f M_SQRT2f128 M_SQRT2f32 M_SQRT2f32x M_SQRT2f64 M_SQRT2f64x M_SQRT2l NAN NFDBITS NULL \
    O_ACCMODE O_APPEND O_ASYNC O_CLOEXEC O_CREAT O_DIRECT O_DIRECTORY O_DSYNC O_EXCL O_FSYNC O_LARGEFILE O_NDELAY \
    O_NOATIME O_NOCTTY O_NOFOLLOW O_NONBLOCK O_PATH O_RDONLY O_RDWR O_RSYNC O_SYNC O_TMPFILE O_TRUNC O_WRONLY \
    PDP_ENDIAN POSIX_FADV_DONTNEED POSIX_FADV_NOREUSE POSIX_FADV_NORMAL POSIX_FADV_RANDOM POSIX_FADV_SEQUENTIAL \
    POSIX_FADV_WILLNEED PTHREAD_ADAPTIVE_MUTEX_INITIALIZER_NP PTHREAD_ATTR_NO_SIGMASK_NP \
    PTHREAD_BARRIER_SERIAL_THREAD PTHREAD_CANCELED PTHREAD_CANCEL_ASYNCHRONOUS PTHREAD_CANCEL_DEFERRED \
    PTHREAD_CANCEL_DISABLE PTHREAD_CANCEL_ENABLE PTHREAD_COND_INITIALIZER PTHREAD_CREATE_DETACHED \
    PTHREAD_CREATE_JOINABLE PTHREAD_ERRORCHECK_MUTEX_INITIALIZER_NP PTHREAD_EXPLICIT_SCHED PTHREAD_INHERIT_SCHED \
    PTHREAD_MUTEX_ADAPTIVE_NP PTHREAD_MUTEX_DEFAULT PTHREAD_MUTEX_ERRORCHECK PTHREAD_MUTEX_ERRORCHECK_NP \
    PTHREAD_MUTEX_FAST_NP PTHREAD_MUTEX_INITIALIZER PTHREAD_MUTEX_NORMAL PTHREAD_MUTEX_RECURSIVE \
    PTHREAD_MUTEX_RECURSIVE_NP PTHREAD_MUTEX_ROBUST PTHREAD_MUTEX_ROBUST_NP PTHREAD_MUTEX_STALLED \
    PTHREAD_MUTEX_STALLED_NP PTHREAD_MUTEX_TIMED_NP PTHREAD_ONCE_INIT PTHREAD_PRIO_INHERIT PTHREAD_PRIO_NONE \
    PTHREAD_PRIO_PROTECT PTHREAD_PROCESS_PRIVATE PTHREAD_PROCESS_SHARED PTHREAD_RECURSIVE_MUTEX_INITIALIZER_NP \
    PTHREAD_RWLOCK_DEFAULT_NP PTHREAD_RWLOCK_INITIALIZER PTHREAD_RWLOCK_PREFER_READER_NP \
    PTHREAD_RWLOCK_PREFER_WRITER_NONRECURSIVE_NP PTHREAD_RWLOCK_PREFER_WRITER_NP \
    PTHREAD_RWLOCK_WRITER_NONRECURSIVE_INITIALIZER_NP PTHREAD_SCOPE_PROCESS PTHREAD_SCOPE_SYSTEM PTHREAD_STACK_MIN \
    P_tmpdir RAND_MAX RENAME_EXCHANGE RENAME_NOREPLACE RENAME_WHITEOUT RWF_WRITE_LIFE_NOT_SET RWH_WRITE_LIFE_EXTREME \
    RWH_WRITE_LIFE_LONG RWH_WRITE_LIFE_MEDIUM RWH_WRITE_LIFE_NONE RWH_WRITE_LIFE_NOT_SET RWH_WRITE_LIFE_SHORT R_OK \
    SCHED_BATCH SCHED_DEADLINE SCHED_FIFO SCHED_IDLE SCHED_ISO SCHED_OTHER SCHED_RESET_ON_FORK SCHED_RR SEEK_CUR \
    SEEK_DATA SEEK_END SEEK_HOLE SEEK_SET SNAN SNANF SNANF128 SNANF32 SNANF32X SNANF64 SNANF64X SNANL SPLICE_F_GIFT \
    SPLICE_F_MORE SPLICE_F_MOVE SPLICE_F_NONBLOCK STA_CLK STA_CLOCKERR STA_DEL STA_FLL STA_FREQHOLD STA_INS STA_MODE \
    STA_NANO STA_PLL STA_PPSERROR STA_PPSFREQ STA_PPSJITTER STA_PPSSIGNAL STA_PPSTIME STA_PPSWANDER STA_RONLY \
    STA_UNSYNC STDERR_FILENO STDIN_FILENO STDOUT_FILENO SYNC_FILE_RANGE_WAIT_AFTER SYNC_FILE_RANGE_WAIT_BEFORE \
    SYNC_FILE_RANGE_WRITE SYNC_FILE_RANGE_WRITE_AND_WAIT S_IFBLK S_IFCHR S_IFDIR S_IFIFO S_IFLNK S_IFMT S_IFREG \
    S_IFSOCK S_IRGRP S_IROTH S_IRUSR S_IRWXG S_IRWXO S_IRWXU S_ISGID S_ISUID S_ISVTX S_IWGRP S_IWOTH S_IWUSR S_IXGRP \
    S_IXOTH S_IXUSR TEMP_FAILURE_RETRY TIMER_ABSTIME TIME_UTC TMP_MAX UTIME_NOW UTIME_OMIT WCONTINUED WEXITED \
    WEXITSTATUS WIFCONTINUED WIFEXITED WIFSIGNALED WIFSTOPPED WNOHANG WNOWAIT WSTOPPED WSTOPSIG WTERMSIG WUNTRACED \
    W_OK X_OK a64l abort abs access acct acos acosf acosf128 acosf32 acosf32x acosf64 acosf64x acosh acoshf \
    acoshf128 acoshf32 acoshf32x acoshf64 acoshf64x acoshl acosl alarm aligned_alloc alloca arc4random \
    arc4random_buf arc4random_uniform asctime asctime_r asin asinf asinf128 asinf32 asinf32x asinf64 asinf64x asinh \
    asinhf asinhf128 asinhf32 asinhf32x asinhf64 asinhf64x asinhl asinl asprintf at_quick_exit atan atan2 atan2f \
    atan2f128 atan2f32 atan2f32x atan2f64 atan2f64x atan2l atanf atanf128 atanf32 atanf32x atanf64 atanf64x atanh \
    atanhf atanhf128 atanhf32 atanhf32x atanhf64 atanhf64x atanhl atanl atexit atof atoi atol atoll basename bcmp \
    bcopy be16toh be32toh be64toh blkcnt64_t blkcnt_t blksize_t brk bsearch bzero caddr_t calloc canonicalize \
    canonicalize_file_name canonicalizef canonicalizef128 canonicalizef32 canonicalizef32x canonicalizef64 \
    canonicalizef64x canonicalizel cbrt cbrtf cbrtf128 cbrtf32 cbrtf32x cbrtf64 cbrtf64x cbrtl ceil ceilf ceilf128 \
    ceilf32 ceilf32x ceilf64 ceilf64x ceill chdir chown chroot clearenv clearerr clearerr_unlocked clock \
    clock_adjtime clock_getcpuclockid clock_getres clock_gettime clock_nanosleep clock_settime clock_t clockid_t \
    clone close close_range closefrom comparison_fn_t confstr cookie_close_function_t cookie_read_function_t \
    cookie_seek_function_t cookie_write_function_t copy_file_range copysign copysignf copysignf128 copysignf32 \
    copysignf32x copysignf64 copysignf64x copysignl cos cosf cosf128 cosf32 cosf32x cosf64 cosf64x cosh coshf \
    coshf128 coshf32 coshf32x coshf64 coshf64x coshl cosl creat creat64 crypt ctermid ctime ctime_r cuserid daddl \
    daddr_t daemon daylight ddivl dev_t dfmal difftime div dmull double_t dprintf drand48 drand48_r drem dremf dreml \
    dsqrtl dsubl dup dup2 dup3 dysize eaccess ecvt ecvt_r endusershell environ erand48 erand48_r erf erfc erfcf \
    erfcf128 erfcf32 erfcf32x erfcf64 erfcf64x erfcl erff erff128 erff32 erff32x erff64 erff64x erfl errno error_t \
    euidaccess execl execle execlp execv execve execveat execvp execvpe exit exp exp10 exp10f exp10f128 exp10f32 \
    exp10f32x exp10f64 exp10f64x exp10l exp2 exp2f exp2f128 exp2f32 exp2f32x exp2f64 exp2f64x exp2l expf expf128 \
    expf32 expf32x expf64 expf64x expl explicit_bzero expm1 expm1f expm1f128 expm1f32 expm1f32x expm1f64 expm1f64x \
    expm1l f32addf128 f32addf32x f32addf64 f32addf64x f32divf128 f32divf32x f32divf64 f32divf64x f32fmaf128 \
    f32fmaf32x f32fmaf64 f32fmaf64x f32mulf128 f32mulf32x f32mulf64 f32mulf64x f32sqrtf128 f32sqrtf32x f32sqrtf64 \
    f32sqrtf64x f32subf128 f32subf32x f32subf64 f32subf64x f32xaddf128 f32xaddf64 f32xaddf64x f32xdivf128 f32xdivf64 \
    f32xdivf64x f32xfmaf128 f32xfmaf64 f32xfmaf64x f32xmulf128 f32xmulf64 f32xmulf64x f32xsqrtf128 f32xsqrtf64 \
    f32xsqrtf64x f32xsubf128 f32xsubf64 f32xsubf64x f64addf128 f64addf64x f64divf128 f64divf64x f64fmaf128 \
    f64fmaf64x f64mulf128 f64mulf64x f64sqrtf128 f64sqrtf64x f64subf128 f64subf64x f64xaddf128 f64xdivf128 \
    f64xfmaf128 f64xmulf128 f64xsqrtf128 f64xsubf128 fabs fabsf fabsf128 fabsf32 fabsf32x fabsf64 fabsf64x fabsl \
    faccessat fadd faddl fallocate fallocate64 fchdir fchown fchownat fclose fcloseall fcntl fcntl64 fcvt fcvt_r \
    fd_mask fdatasync fdim fdimf fdimf128 fdimf32 fdimf32x fdimf64 fdimf64x fdiml fdiv fdivl fdopen feof \
    feof_unlocked ferror ferror_unlocked fexecve fflush fflush_unlocked ffma ffmal ffs ffsl ffsll fgetc \
    fgetc_unlocked fgetpos fgetpos64 fgets fgets_unlocked fileno fileno_unlocked finite finitef finitel float_t \
    flockfile floor floorf floorf128 floorf32 floorf32x floorf64 floorf64x floorl fma fmaf fmaf128 fmaf32 fmaf32x \
    fmaf64 fmaf64x fmal fmax fmaxf fmaxf128 fmaxf32 fmaxf32x fmaxf64 fmaxf64x fmaximum fmaximum_mag fmaximum_mag_num \
    fmaximum_mag_numf fmaximum_mag_numf128 fmaximum_mag_numf32 fmaximum_mag_numf32x fmaximum_mag_numf64 \
    fmaximum_mag_numf64x fmaximum_mag_numl fmaximum_magf fmaximum_magf128 fmaximum_magf32 fmaximum_magf32x \
    fmaximum_magf64 fmaximum_magf64x fmaximum_magl fmaximum_num fmaximum_numf fmaximum_numf128 fmaximum_numf32 \
    fmaximum_numf32x fmaximum_numf64 fmaximum_numf64x fmaximum_numl fmaximumf fmaximumf128 fmaximumf32 fmaximumf32x \
    fmaximumf64 fmaximumf64x fmaximuml fmaxl fmaxmag fmaxmagf fmaxmagf128 fmaxmagf32 fmaxmagf32x fmaxmagf64 \
    fmaxmagf64x fmaxmagl fmemopen fmin fminf fminf128 fminf32 fminf32x fminf64 fminf64x fminimum fminimum_mag \
    fminimum_mag_num fminimum_mag_numf fminimum_mag_numf128 fminimum_mag_numf32 fminimum_mag_numf32x \
    fminimum_mag_numf64 fminimum_mag_numf64x fminimum_mag_numl fminimum_magf fminimum_magf128 fminimum_magf32 \
    fminimum_magf32x fminimum_magf64 fminimum_magf64x fminimum_magl fminimum_num fminimum_numf fminimum_numf128 \
    fminimum_numf32 fminimum_numf32x fminimum_numf64 fminimum_numf64x fminimum_numl fminimumf fminimumf128 \
    fminimumf32 fminimumf32x fminimumf64 fminimumf64x fminimuml fminl fminmag fminmagf fminmagf128 fminmagf32 \
    fminmagf32x fminmagf64 fminmagf64x fminmagl fmod fmodf fmodf128 fmodf32 fmodf32x fmodf64 fmodf64x fmodl fmul \
    fmull fopen fopen64 fopencookie fork fpathconf fpclassify fpos64_t fpos_t fprintf fputc fputc_unlocked fputs \
    fputs_unlocked fread fread_unlocked free freopen freopen64 frexp frexpf frexpf128 frexpf32 frexpf32x frexpf64 \
    frexpf64x frexpl fromfp fromfpf fromfpf128 fromfpf32 fromfpf32x fromfpf64 fromfpf64x fromfpl fromfpx fromfpxf \
    fromfpxf128 fromfpxf32 fromfpxf32x fromfpxf64 fromfpxf64x fromfpxl fsblkcnt64_t fsblkcnt_t fscanf fseek fseeko \
    fseeko64 fsetpos fsetpos64 fsfilcnt64_t fsfilcnt_t fsid_t fsqrt fsqrtl fsub fsubl fsync ftell ftello ftello64 \
    ftruncate ftruncate64 ftrylockfile funlockfile fwrite fwrite_unlocked gamma gammaf gammal gcvt \
    get_current_dir_name getc getc_unlocked getchar getchar_unlocked getcpu getcwd getdate getdate_err getdate_r \
    getdelim getdomainname getdtablesize getegid getentropy getenv geteuid getgid getgroups gethostid gethostname \
    getline getloadavg getlogin getlogin_r getopt getpagesize getpass getpayload getpayloadf getpayloadf128 \
    getpayloadf32 getpayloadf32x getpayloadf64 getpayloadf64x getpayloadl getpgid getpgrp getpid getppid getpt \
    getresgid getresuid getsid getsubopt gettid getuid getusershell getw getwd gid_t gmtime gmtime_r grantpt \
    group_member htobe16 htobe32 htobe64 htole16 htole32 htole64 hypot hypotf hypotf128 hypotf32 hypotf32x hypotf64 \
    hypotf64x hypotl id_t ilogb ilogbf ilogbf128 ilogbf32 ilogbf32x ilogbf64 ilogbf64x ilogbl index initstate \
    initstate_r ino64_t ino_t int16_t int32_t int64_t int8_t intptr_t isatty iscanonical iseqsig isfinite isgreater \
    isgreaterequal isinf isinff isinfl isless islessequal islessgreater isnan isnanf isnanl isnormal issignaling \
    issubnormal isunordered iszero j0 j0f j0f128 j0f32 j0f32x j0f64 j0f64x j0l j1 j1f j1f128 j1f32 j1f32x j1f64 \
    j1f64x j1l jn jnf jnf128 jnf32 jnf32x jnf64 jnf64x jnl jrand48 jrand48_r key_t l64a labs lchown lcong48 \
    lcong48_r ldexp ldexpf ldexpf128 ldexpf32 ldexpf32x ldexpf64 ldexpf64x ldexpl ldiv le16toh le32toh le64toh \
    lgamma lgamma_r lgammaf lgammaf128 lgammaf128_r lgammaf32 lgammaf32_r lgammaf32x lgammaf32x_r lgammaf64 \
    lgammaf64_r lgammaf64x lgammaf64x_r lgammaf_r lgammal lgammal_r link linkat linux llabs lldiv llogb llogbf \
    llogbf128 llogbf32 llogbf32x llogbf64 llogbf64x llogbl llrint llrintf llrintf128 llrintf32 llrintf32x llrintf64 \
    llrintf64x llrintl llround llroundf llroundf128 llroundf32 llroundf32x llroundf64 llroundf64x llroundl locale_t \
    localtime localtime_r lockf lockf64 loff_t log log10 log10f log10f128 log10f32 log10f32x log10f64 log10f64x \
    log10l log1p log1pf log1pf128 log1pf32 log1pf32x log1pf64 log1pf64x log1pl log2 log2f log2f128 log2f32 log2f32x \
    log2f64 log2f64x log2l logb logbf logbf128 logbf32 logbf32x logbf64 logbf64x logbl logf logf128 logf32 logf32x \
    logf64 logf64x logl lrand48 lrand48_r lrint lrintf lrintf128 lrintf32 lrintf32x lrintf64 lrintf64x lrintl lround \
    lroundf lroundf128 lroundf32 lroundf32x lroundf64 lroundf64x lroundl lseek lseek64 malloc math_errhandling mblen \
    mbstowcs mbtowc memccpy memchr memcmp memcpy memfrob memmem memmove mempcpy memrchr memset mkdtemp mkostemp \
    mkostemp64 mkostemps mkostemps64 mkstemp mkstemp64 mkstemps mkstemps64 mktemp mktime mode_t modf modff modff128 \
    modff32 modff32x modff64 modff64x modfl mrand48 mrand48_r name_to_handle_at nan nanf nanf128 nanf32 nanf32x \
    nanf64 nanf64x nanl nanosleep nearbyint nearbyintf nearbyintf128 nearbyintf32 nearbyintf32x nearbyintf64 \
    nearbyintf64x nearbyintl nextafter nextafterf nextafterf128 nextafterf32 nextafterf32x nextafterf64 \
    nextafterf64x nextafterl nextdown nextdownf nextdownf128 nextdownf32 nextdownf32x nextdownf64 nextdownf64x \
    nextdownl nexttoward nexttowardf nexttowardl nextup nextupf nextupf128 nextupf32 nextupf32x nextupf64 nextupf64x \
    nextupl nice nlink_t nrand48 nrand48_r obstack_printf obstack_vprintf off64_t off_t on_exit open open64 \
    open_by_handle_at open_memstream openat openat64 optarg opterr optind optopt pathconf pause pclose perror pid_t \
    pipe pipe2 popen posix_fadvise posix_fadvise64 posix_fallocate posix_fallocate64 posix_memalign posix_openpt pow \
    powf powf128 powf32 powf32x powf64 powf64x powl pread pread64 printf profil program_invocation_name \
    program_invocation_short_name pselect pthread_atfork pthread_attr_destroy pthread_attr_getaffinity_np \
    pthread_attr_getdetachstate pthread_attr_getguardsize pthread_attr_getinheritsched pthread_attr_getschedparam \
    pthread_attr_getschedpolicy pthread_attr_getscope pthread_attr_getsigmask_np pthread_attr_getstack \
    pthread_attr_getstackaddr pthread_attr_getstacksize pthread_attr_init pthread_attr_setaffinity_np \
    pthread_attr_setdetachstate pthread_attr_setguardsize pthread_attr_setinheritsched pthread_attr_setschedparam \
    pthread_attr_setschedpolicy pthread_attr_setscope pthread_attr_setsigmask_np pthread_attr_setstack \
    pthread_attr_setstackaddr pthread_attr_setstacksize pthread_attr_t pthread_barrier_destroy pthread_barrier_init \
    pthread_barrier_wait pthread_barrierattr_destroy pthread_barrierattr_getpshared pthread_barrierattr_init \
    pthread_barrierattr_setpshared pthread_cancel pthread_cleanup_pop pthread_cleanup_pop_restore_np \
    pthread_cleanup_push pthread_cleanup_push_defer_np pthread_clockjoin_np pthread_cond_broadcast \
    pthread_cond_clockwait pthread_cond_destroy pthread_cond_init pthread_cond_signal pthread_cond_timedwait \
    pthread_cond_wait pthread_condattr_destroy pthread_condattr_getclock pthread_condattr_getpshared \
    pthread_condattr_init pthread_condattr_setclock pthread_condattr_setpshared pthread_create pthread_detach \
    pthread_equal pthread_exit pthread_getaffinity_np pthread_getattr_default_np pthread_getattr_np \
    pthread_getconcurrency pthread_getcpuclockid pthread_getname_np pthread_getschedparam pthread_getspecific \
    pthread_join pthread_key_create pthread_key_delete pthread_key_t pthread_mutex_clocklock \
    pthread_mutex_consistent pthread_mutex_consistent_np pthread_mutex_destroy pthread_mutex_getprioceiling \
    pthread_mutex_init pthread_mutex_lock pthread_mutex_setprioceiling pthread_mutex_timedlock pthread_mutex_trylock \
    pthread_mutex_unlock pthread_mutexattr_destroy pthread_mutexattr_getprioceiling pthread_mutexattr_getprotocol \
    pthread_mutexattr_getpshared pthread_mutexattr_getrobust pthread_mutexattr_getrobust_np \
    pthread_mutexattr_gettype pthread_mutexattr_init pthread_mutexattr_setprioceiling pthread_mutexattr_setprotocol \
    pthread_mutexattr_setpshared pthread_mutexattr_setrobust pthread_mutexattr_setrobust_np \
    pthread_mutexattr_settype pthread_once pthread_once_t pthread_rwlock_clockrdlock pthread_rwlock_clockwrlock \
    pthread_rwlock_destroy pthread_rwlock_init pthread_rwlock_rdlock pthread_rwlock_timedrdlock \
    pthread_rwlock_timedwrlock pthread_rwlock_tryrdlock pthread_rwlock_trywrlock pthread_rwlock_unlock \
    pthread_rwlock_wrlock pthread_rwlockattr_destroy pthread_rwlockattr_getkind_np pthread_rwlockattr_getpshared \
    pthread_rwlockattr_init pthread_rwlockattr_setkind_np pthread_rwlockattr_setpshared pthread_self \
    pthread_setaffinity_np pthread_setattr_default_np pthread_setcancelstate pthread_setcanceltype \
    pthread_setconcurrency pthread_setname_np pthread_setschedparam pthread_setschedprio pthread_setspecific \
    pthread_spin_destroy pthread_spin_init pthread_spin_lock pthread_spin_trylock pthread_spin_unlock \
    pthread_spinlock_t pthread_t pthread_testcancel pthread_timedjoin_np pthread_tryjoin_np pthread_yield ptsname \
    ptsname_r putc putc_unlocked putchar putchar_unlocked putenv puts putw pwrite pwrite64 qecvt qecvt_r qfcvt \
    qfcvt_r qgcvt qsort qsort_r quad_t quick_exit quot rand rand_r random random_r rawmemchr read readahead readlink \
    readlinkat realloc reallocarray realpath remainder remainderf remainderf128 remainderf32 remainderf32x \
    remainderf64 remainderf64x remainderl remove remquo remquof remquof128 remquof32 remquof32x remquof64 remquof64x \
    remquol rename renameat renameat2 revoke rewind rindex rint rintf rintf128 rintf32 rintf32x rintf64 rintf64x \
    rintl rmdir round roundeven roundevenf roundevenf128 roundevenf32 roundevenf32x roundevenf64 roundevenf64x \
    roundevenl roundf roundf128 roundf32 roundf32x roundf64 roundf64x roundl rpmatch sbrk scalb scalbf scalbl \
    scalbln scalblnf scalblnf128 scalblnf32 scalblnf32x scalblnf64 scalblnf64x scalblnl scalbn scalbnf scalbnf128 \
    scalbnf32 scalbnf32x scalbnf64 scalbnf64x scalbnl scanf sched_get_priority_max sched_get_priority_min \
    sched_getaffinity sched_getcpu sched_getparam sched_getscheduler sched_priority sched_rr_get_interval \
    sched_setaffinity sched_setparam sched_setscheduler sched_yield secure_getenv seed48 seed48_r select setbuf \
    setbuffer setdomainname setegid setenv seteuid setgid sethostid sethostname setlinebuf setlogin setns setpayload \
    setpayloadf setpayloadf128 setpayloadf32 setpayloadf32x setpayloadf64 setpayloadf64x setpayloadl setpayloadsig \
    setpayloadsigf setpayloadsigf128 setpayloadsigf32 setpayloadsigf32x setpayloadsigf64 setpayloadsigf64x \
    setpayloadsigl setpgid setpgrp setregid setresgid setresuid setreuid setsid setstate setstate_r setuid \
    setusershell setvbuf sigabbrev_np sigdescr_np signbit signgam significand significandf significandl sigset_t sin \
    sincos sincosf sincosf128 sincosf32 sincosf32x sincosf64 sincosf64x sincosl sinf sinf128 sinf32 sinf32x sinf64 \
    sinf64x sinh sinhf sinhf128 sinhf32 sinhf32x sinhf64 sinhf64x sinhl sinl size_t sizeof sleep snprintf socklen_t \
    splice sprintf sqrt sqrtf sqrtf128 sqrtf32 sqrtf32x sqrtf64 sqrtf64x sqrtl srand srand48 srand48_r srandom \
    srandom_r sscanf ssize_t st_atime st_ctime st_mtime stderr stdin stdout stpcpy stpncpy strcasecmp strcasecmp_l \
    strcasestr strcat strchr strchrnul strcmp strcoll strcoll_l strcpy strcspn strdup strdupa strerror strerror_l \
    strerror_r strerrordesc_np strerrorname_np strfromd strfromf strfromf128 strfromf32 strfromf32x strfromf64 \
    strfromf64x strfroml strfry strftime strftime_l strlen strncasecmp strncasecmp_l strncat strncmp strncpy strndup \
    strndupa strnlen strpbrk strptime strptime_l strrchr strsep strsignal strspn strstr strtod strtod_l strtof \
    strtof128 strtof128_l strtof32 strtof32_l strtof32x strtof32x_l strtof64 strtof64_l strtof64x strtof64x_l \
    strtof_l strtok strtok_r strtol strtol_l strtold strtold_l strtoll strtoll_l strtoq strtoul strtoul_l strtoull \
    strtoull_l strtouq strverscmp strxfrm strxfrm_l suseconds_t swab symlink symlinkat sync sync_file_range syncfs \
    syscall sysconf system tan tanf tanf128 tanf32 tanf32x tanf64 tanf64x tanh tanhf tanhf128 tanhf32 tanhf32x \
    tanhf64 tanhf64x tanhl tanl tcgetpgrp tcsetpgrp tee tempnam tgamma tgammaf tgammaf128 tgammaf32 tgammaf32x \
    tgammaf64 tgammaf64x tgammal time time_t timegm timelocal timer_create timer_delete timer_getoverrun \
    timer_gettime timer_settime timer_t timespec_get timespec_getres timezone tmpfile tmpfile64 tmpnam tmpnam_r \
    totalorder totalorderf totalorderf128 totalorderf32 totalorderf32x totalorderf64 totalorderf64x totalorderl \
    totalordermag totalordermagf totalordermagf128 totalordermagf32 totalordermagf32x totalordermagf64 \
    totalordermagf64x totalordermagl trunc truncate truncate64 truncf truncf128 truncf32 truncf32x truncf64 \
    truncf64x truncl ttyname ttyname_r ttyslot tzname tzset u_char u_int u_int16_t u_int32_t u_int64_t u_int8_t \
    u_long u_quad_t u_short ualarm ufromfp ufromfpf ufromfpf128 ufromfpf32 ufromfpf32x ufromfpf64 ufromfpf64x \
    ufromfpl ufromfpx ufromfpxf ufromfpxf128 ufromfpxf32 ufromfpxf32x ufromfpxf64 ufromfpxf64x ufromfpxl uid_t uint \
    ulong ungetc unix unlink unlinkat unlockpt unsetenv unshare useconds_t ushort usleep va_list valloc vasprintf \
    vdprintf vfork vfprintf vfscanf vhangup vmsplice vprintf vscanf vsnprintf vsprintf vsscanf wchar_t wcstombs \
    wctomb write y0 y0f y0f128 y0f32 y0f32x y0f64 y0f64x y0l y1 y1f y1f128 y1f32 y1f32x y1f64 y1f64x y1l yn ynf \
    ynf128 ynf32 ynf32x ynf64 ynf64x ynl";
