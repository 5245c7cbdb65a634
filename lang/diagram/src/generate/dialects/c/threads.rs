//! Threads of programs in C: POSIX threads that take turns, and end where others end them.
//!
//! Owns one helper: who runs, who waits, and how the program ends.

/// What it defines, and how.
pub(super) const THREADS: (&str, &str) = (
    "startThread joinThread killThread",
    "
#define HAS_THREADS
/* Threads take turns: one runs until it waits. The first one is the program itself. */
static pthread_mutex_t turn = PTHREAD_MUTEX_INITIALIZER;
static pthread_cond_t ended;
static struct Thread { Text name; void (*run)(void); pthread_t id; int runs; } threads[100];
static int threadCount;
static __thread struct Thread *current;

static void endThreads(void);

static struct timespec after(Whole ms)
{
    struct timespec time;

    clock_gettime(CLOCK_MONOTONIC, &time);
    time.tv_sec += ms / 1000;
    time.tv_nsec += ms % 1000 * 1000000;
    if (time.tv_nsec >= 1000000000) {
        time.tv_sec++;
        time.tv_nsec -= 1000000000;
    }
    return time;
}

/* The present thread ends here if it was killed. */
static void mayEnd(void)
{
    if (current->runs)
        return;
    if (current == threads) {
        endThreads();
        exit(0);
    }
    pthread_mutex_unlock(&turn);
    pthread_exit(NULL);
}

/* Others run until the time is over or a thread ends; whether it is over. */
static int giveTurn(const struct timespec *until)
{
    int result = pthread_cond_timedwait(&ended, &turn, until);

    mayEnd();
    return result == ETIMEDOUT;
}

static __attribute__((unused)) void pauseFor(Whole ms)
{
    struct timespec until = after(ms);

    while (!giveTurn(&until))
        ;
}

static void *runThread(void *thread)
{
    current = thread;
    pthread_mutex_lock(&turn);
    mayEnd();
    current->run();
    current->runs = 0;
    pthread_cond_broadcast(&ended);
    pthread_mutex_unlock(&turn);
    return NULL;
}

static __attribute__((unused)) void startThread(Text name, void (*run)(void))
{
    struct Thread *thread = &threads[threadCount];

    if (threadCount == 100)
        fail(\"too many threads\");
    threadCount++;
    thread->name = name;
    thread->run = run;
    thread->runs = 1;
    if (pthread_create(&thread->id, NULL, runThread, thread) != 0)
        fail(\"pthread_create\");
}

static int isRunning(const Text *name)
{
    int index, found = 0;

    for (index = 0; index < threadCount; index++)
        found |= threads[index].runs && (!name || strcmp(threads[index].name.at, name->at) == 0);
    return found;
}

static __attribute__((unused)) void joinThread(Text name)
{
    while (isRunning(&name)) {
        struct timespec until = after(1000);

        giveTurn(&until);
    }
}

static __attribute__((unused)) void killThread(Text name)
{
    int index;

    for (index = 0; index < threadCount; index++)
        if (strcmp(threads[index].name.at, name.at) == 0)
            threads[index].runs = 0;
    pthread_cond_broadcast(&ended);
    mayEnd();
}

static void beginThreads(void)
{
    pthread_condattr_t clock;

    pthread_condattr_init(&clock);
    pthread_condattr_setclock(&clock, CLOCK_MONOTONIC);
    pthread_cond_init(&ended, &clock);
    pthread_mutex_lock(&turn);
    current = threads;
    threads[threadCount++] = (struct Thread) { textOf(\"main\"), NULL, pthread_self(), 1 };
}

/* The program ends when all its threads have ended. */
static void endThreads(void)
{
    threads[0].runs = 0;
    pthread_cond_broadcast(&ended);
    while (isRunning(NULL)) {
        struct timespec until = after(1000);

        pthread_cond_timedwait(&ended, &turn, &until);
    }
}",
);
