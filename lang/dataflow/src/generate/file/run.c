#include "trikfs_converter.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Reactions in an instant, tokens on their way, and instants that make up for timers between two tuples. */
#define FIRINGS_MAX 10000
#define DELIVERIES_MAX 1000000
#define INSTANTS_MAX 100
/* The first tuple is the first poll of a program, which comes after its beginning. */
#define POLL_US 20000.0

enum kind { UNIT, TRUTH, NUMBER, LIST };

/* What a token carries. Items of lists are numbers. */
struct value {
    int kind;
    int count;
    double number;
    double items[ITEMS];
};

/* Tokens that wait: a ring that grows. */
struct queue {
    struct value *at;
    int *places;
    int size;
    int first;
    int count;
};

struct timer {
    int is_set;
    double due;
    double order;
};

/* fields */

static void fail(struct state *s, const char *reason)
{
    if (s->fault == NULL) {
        s->fault = reason;
    }
}

static const struct value NOTHING;

static inline struct value unit(void) { return NOTHING; }

static inline struct value numberValue(double number)
{
    struct value made = NOTHING;
    made.kind = NUMBER;
    made.number = number;
    return made;
}

static inline struct value truthValue(int truth)
{
    struct value made = NOTHING;
    made.kind = TRUTH;
    made.number = truth != 0;
    return made;
}

static inline double number(struct state *s, struct value value)
{
    if (value.kind == NUMBER || value.kind == TRUTH) {
        return value.number;
    }
    fail(s, value.kind == UNIT ? "there is no value where a number is needed" : "a list is no number");
    return 0;
}

static inline double whole(double number)
{
    double down;
    if (!(number > -9.2e18 && number < 9.2e18)) {
        return 0;
    }
    down = floor(number);
    if (number - down >= 0.5) {
        down += 1;
    }
    if (down >= -2147483648.0 && down <= 2147483647.0) {
        return down;
    }
    down -= floor(down / 4294967296.0) * 4294967296.0;
    return down >= 2147483648.0 ? down - 4294967296.0 : down;
}

static inline double asWhole(struct state *s, struct value value)
{
    double away;
    if (value.kind != NUMBER) {
        fail(s, value.kind == UNIT ? "there is no value where a number is needed" : "this is no number");
        return 0;
    }
    away = round(value.number);
    if (!(fabs(away) <= 2147483647.0)) {
        fail(s, "the number is too large for a whole one");
        return 0;
    }
    return away;
}

static inline int truth(struct value value)
{
    return (value.kind == NUMBER || value.kind == TRUTH) && value.number != 0;
}

static inline double cut(double number)
{
    if (number != number) {
        return 0;
    }
    return number > 2147483647.0 ? 2147483647.0 : number < -2147483648.0 ? -2147483648.0 : number;
}

static inline double sign(double number) { return (number > 0) - (number < 0); }
static inline double least(double one, double other) { return one < other ? one : other; }
static inline double most(double one, double other) { return one < other ? other : one; }
static inline double clamp(double number, double limit) { return number > limit ? limit : number < -limit ? -limit : number; }
static inline void ignore(struct value value) { (void)value; }

static inline double divide(struct state *s, double left, double right)
{
    if (right == 0) {
        fail(s, "division by 0");
        return 0;
    }
    return left / right;
}

static inline double divideWhole(struct state *s, double left, double right)
{
    if (right == 0) {
        fail(s, "division by 0");
        return 0;
    }
    return whole(floor(left / right));
}

static inline double modulo(struct state *s, double left, double right)
{
    if (right == 0) {
        fail(s, "division by 0");
        return 0;
    }
    return left - floor(left / right) * right;
}

static inline double bitAnd(double left, double right) { return (double)((int32_t)left & (int32_t)right); }
static inline double bitOr(double left, double right) { return (double)((int32_t)left | (int32_t)right); }
static inline double bitXor(double left, double right) { return (double)((int32_t)left ^ (int32_t)right); }
static inline double bitNot(double number) { return (double)~(int32_t)number; }

static inline double shiftLeft(double left, double right)
{
    return right >= 0 && right < 32 ? (double)(int32_t)((uint32_t)(int32_t)left << (int)right) : 0;
}

static inline double shiftRight(double left, double right)
{
    if (right >= 0 && right < 32) {
        return floor(left / (double)(1LL << (int)right));
    }
    return left < 0 ? -1 : 0;
}

static inline int same(struct value one, struct value other)
{
    int at;
    if (one.kind == LIST && other.kind == LIST) {
        if (one.count != other.count) {
            return 0;
        }
        for (at = 0; at < one.count; at++) {
            if (one.items[at] != other.items[at]) {
                return 0;
            }
        }
        return 1;
    }
    if (one.kind == UNIT || other.kind == UNIT || one.kind == LIST || other.kind == LIST) {
        return one.kind == UNIT && other.kind == UNIT;
    }
    return one.number == other.number;
}

static inline struct value item(struct state *s, struct value list, double at)
{
    if (at < 0) {
        fail(s, "an index is below 0");
        return unit();
    }
    return list.kind == LIST && at < list.count ? numberValue(list.items[(int)at]) : unit();
}

static inline struct value listOf(struct state *s, int count, const struct value *items)
{
    struct value made = NOTHING;
    int at;
    made.kind = LIST;
    made.count = count;
    for (at = 0; at < count; at++) {
        made.items[at] = number(s, items[at]);
    }
    return made;
}

static inline struct value put(struct state *s, struct value list, double at, struct value value)
{
    if (at < 0) {
        fail(s, "an index is below 0");
        return list;
    }
    if (list.kind != LIST) {
        list.kind = LIST;
        list.count = 0;
    }
    if (at > list.count || at >= ITEMS) {
        fail(s, "an index is beyond the end of the list, which cannot grow so far in C");
        return list;
    }
    if (at == list.count) {
        list.count++;
    }
    list.items[(int)at] = number(s, value);
    return list;
}

static inline double length(struct state *s, struct value list)
{
    if (list.kind != LIST) {
        fail(s, "only lists have a length here");
        return 0;
    }
    return list.count;
}

static inline struct value needsValue(struct state *s, struct value value)
{
    if (value.kind == UNIT) {
        fail(s, "there is no value");
    }
    return value;
}

static inline void needsItems(struct state *s, struct value list, int count)
{
    if (list.kind != LIST || list.count < count) {
        fail(s, "a list of more items is needed");
    }
}

static inline double roundUp(double ms) { return ms < 1 ? 10 : ceil(ms / 10) * 10; }
static inline int isOver(double following, double last, double step)
{
    return step > 0 ? following > last : following < last;
}

static void push(struct state *s, struct queue *queue, int place, struct value token, int capacity, int policy)
{
    int at;
    if (queue->count >= capacity) {
        if (policy == 2) {
            fail(s, "too many tokens wait or are on their way");
            return;
        }
        queue->first = (queue->first + 1) % queue->size;
        queue->count--;
    }
    if (queue->count == queue->size) {
        int size = queue->size == 0 ? 16 : queue->size * 2;
        struct value *tokens = malloc((size_t)size * sizeof *tokens);
        int *places = malloc((size_t)size * sizeof *places);
        if (tokens == NULL || places == NULL) {
            free(tokens);
            free(places);
            fail(s, "out of memory");
            return;
        }
        for (at = 0; at < queue->count; at++) {
            tokens[at] = queue->at[(queue->first + at) % queue->size];
            places[at] = queue->places[(queue->first + at) % queue->size];
        }
        free(queue->at);
        free(queue->places);
        queue->at = tokens;
        queue->places = places;
        queue->size = size;
        queue->first = 0;
    }
    at = (queue->first + queue->count) % queue->size;
    queue->at[at] = token;
    queue->places[at] = place;
    queue->count++;
}

static inline struct value take(struct queue *queue)
{
    struct value token = queue->at[queue->first];
    queue->first = (queue->first + 1) % queue->size;
    queue->count--;
    return token;
}

static inline void post(struct state *s, int place, struct value token)
{
    push(s, &s->tokens, place, token, DELIVERIES_MAX, 2);
}

static inline void count(struct state *s)
{
    if (++s->firings > FIRINGS_MAX) {
        fail(s, "a cycle without a wait: more than 10000 reactions");
    }
}

static inline void setTimer(struct state *s, int id, double time)
{
    s->timers[id - 1].is_set = 1;
    s->timers[id - 1].due = time;
    s->timers[id - 1].order = ++s->set;
}

static inline void cancelTimer(struct state *s, int id) { s->timers[id - 1].is_set = 0; }

static inline void repeatTimer(struct state *s, int id, double was, double period)
{
    double time = was + period;
    setTimer(s, id, time > s->now ? time : s->now + period);
}

/* the program */

static void fire(struct state *s)
{
    /* What is set meanwhile is due later. */
    double newest = s->set;
    while (s->fault == NULL) {
        int found = -1;
        int id;
        double time;
        for (id = 0; id < TIMERS; id++) {
            const struct timer *one = &s->timers[id];
            if (one->is_set && one->due <= s->now && one->order <= newest
                && (found < 0 || one->due < s->timers[found].due
                    || (one->due == s->timers[found].due && one->order < s->timers[found].order))) {
                found = id;
            }
        }
        if (found < 0) {
            return;
        }
        time = s->timers[found].due;
        s->timers[found].is_set = 0;
        s->at = ticks[found].about;
        count(s);
        ticks[found].run(s, time);
    }
}

static void deliver(struct state *s)
{
    while (s->tokens.count > 0 && s->fault == NULL) {
        int place = s->tokens.places[s->tokens.first];
        struct value token = take(&s->tokens);
        s->at = reactions[place].about;
        count(s);
        reactions[place].run(s, token);
    }
}

static void instant(struct state *s, double now, int polls)
{
    s->now = now;
    s->firings = 0;
    fire(s);
    if (polls && s->fault == NULL) {
        poll(s);
    }
    deliver(s);
}

static void tuple(struct state *s, double passed, const uint8_t *in)
{
    double now;
    int left;
    if (s->us == 0) {
        s->us = POLL_US;
        readings(s, in);
        begin(s);
        deliver(s);
    }
    s->us += passed;
    now = floor(s->us / 1000);
    for (left = INSTANTS_MAX; left > 0 && s->fault == NULL; left--) {
        double soonest = HUGE_VAL;
        int id;
        for (id = 0; id < TIMERS; id++) {
            if (s->timers[id].is_set && s->timers[id].due < soonest) {
                soonest = s->timers[id].due;
            }
        }
        if (soonest >= now) {
            break;
        }
        instant(s, soonest > s->now ? soonest : s->now, 0);
    }
    if (s->fault == NULL) {
        readings(s, in);
        instant(s, now, 1);
    }
}

/* From the beginning; what was is forgotten. */
static void forget(struct state *s)
{
    struct queue *queues[] = { &s->tokens, QUEUES };
    size_t at;
    for (at = 0; at < sizeof queues / sizeof *queues; at++) {
        free(queues[at]->at);
        free(queues[at]->places);
    }
    memset(s, 0, sizeof *s);
    restart(s);
}

static int opened(const trikfs_open_info *info, void **state)
{
    struct state *s;
    if (info->input_size != INPUT_SIZE || info->output_size != OUTPUT_SIZE) {
        return 2;
    }
    s = calloc(1, sizeof *s);
    if (s == NULL) {
        return 3;
    }
    restart(s);
    *state = s;
    return TRIKFS_OK;
}

static int convert(void *state, const uint8_t *in, uint32_t in_size, uint8_t *out, uint32_t out_size)
{
    struct state *s = state;
    uint32_t us;
    (void)in_size;
    (void)out_size;
    memcpy(&us, in + INPUT_SIZE - sizeof us, sizeof us);
    tuple(s, us, in);
    if (s->fault == NULL && !fields(s, out)) {
        return TRIKFS_CONSUMED;
    }
    if (s->fault != NULL) {
        char text[sizeof s->text];
        if (strncmp(s->fault, "ENODEV: ", 8) == 0) {
            snprintf(text, sizeof text, "%s", s->fault);
        } else {
            snprintf(text, sizeof text, "%s: %s", s->at == NULL ? "the program" : s->at, s->fault);
        }
        forget(s);
        memcpy(s->text, text, sizeof text);
        return 4;
    }
    return TRIKFS_OK;
}

static void closed(void *state)
{
    if (state != NULL) {
        forget(state);
        free(state);
    }
}

static const char *explain(void *state, int code)
{
    switch (code) {
    case 2:
        return "the sizes of the tuples are not those of the program's inputs and outputs";
    case 3:
        return "out of memory";
    default:
        return state == NULL ? NULL : ((struct state *)state)->text;
    }
}

static const trikfs_converter PROGRAM = {
    TRIKFS_ABI_VERSION, sizeof(trikfs_converter), "dataflow", "a program of data flow", INPUT_SIZE, OUTPUT_SIZE,
    opened, convert, closed, explain
};
static const trikfs_converter *const ALL[] = { &PROGRAM };
static const trikfs_library LIBRARY = { TRIKFS_ABI_VERSION, sizeof(trikfs_library), 1, ALL };

TRIKFS_EXPORT const trikfs_library *trikfs_library_entry(void) { return &LIBRARY; }
