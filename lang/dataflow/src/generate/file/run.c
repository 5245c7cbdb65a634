#include "trikfs_converter.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum kind { UNIT, TRUTH, NUMBER, LIST };

/* What a token carries. An item of a list is anything but a list. */
struct value {
    int kind;
    int count;
    double number;
    double items[ITEMS];
    unsigned char kinds[ITEMS];
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
    if (value.kind == NUMBER) {
        return value.number;
    }
    fail(s, value.kind == UNIT ? "there is no value where a number is needed"
            : value.kind == TRUTH ? "a truth is no number" : "a list is no number");
    return 0;
}

static inline double numberOfAny(struct state *s, struct value value)
{
    return value.kind == TRUTH ? value.number : number(s, value);
}

static inline void demand(struct state *s, struct value value)
{
    if (value.kind != UNIT) {
        number(s, value);
    }
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
        /* What is whole has no sign where it is 0: that is what adding 0 does. */
        return down + 0.0;
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
    return away + 0.0;
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
    return (number > 2147483647.0 ? 2147483647.0 : number < -2147483648.0 ? -2147483648.0 : number) + 0.0;
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
    return left - floor(left / right) * right + 0.0;
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
            int is_one = one.kinds[at] != UNIT;
            int is_other = other.kinds[at] != UNIT;
            if (is_one != is_other || (is_one && one.items[at] != other.items[at])) {
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
    struct value made = NOTHING;
    if (at < 0) {
        fail(s, "an index is below 0");
    } else if (list.kind == LIST && at < list.count) {
        made.kind = list.kinds[(int)at];
        made.number = list.items[(int)at];
    }
    return made;
}

/* The first item says what all of them are. */
static inline double numberOfItem(struct state *s, struct value list, double at)
{
    int has_first = list.kind == LIST && list.count > 0 && list.kinds[0] != UNIT;
    if (has_first && list.kinds[0] != NUMBER) {
        fail(s, "a truth is no number");
        return 0;
    }
    return has_first ? numberOfAny(s, item(s, list, at)) : number(s, item(s, list, at));
}

static inline void setItem(struct state *s, struct value *list, int at, struct value value)
{
    if (value.kind == LIST) {
        fail(s, "a list has no place in a list in C");
        return;
    }
    list->kinds[at] = (unsigned char)value.kind;
    list->items[at] = value.number;
}

static inline struct value listOf(struct state *s, int count, const struct value *items)
{
    struct value made = NOTHING;
    int at;
    made.kind = LIST;
    made.count = count;
    for (at = 0; at < count; at++) {
        setItem(s, &made, at, items[at]);
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
        list = NOTHING;
        list.kind = LIST;
    }
    if (at >= ITEMS) {
        fail(s, "an index is beyond the room that lists have in C");
        return list;
    }
    while (list.count <= at) {
        setItem(s, &list, list.count++, NOTHING);
    }
    setItem(s, &list, (int)at, value);
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

/* Makes room for one more token. */
static int grow(struct state *s, struct queue *queue)
{
    int at, size = queue->size == 0 ? 16 : queue->size * 2;
    size_t bytes = (size_t)size * (sizeof *queue->at + sizeof *queue->places);
    struct value *tokens;
    int *places;
    if (s->bytes + bytes > BYTES_MAX) {
        fail(s, "too many tokens wait or are on their way");
        return 0;
    }
    tokens = malloc((size_t)size * sizeof *tokens);
    places = malloc((size_t)size * sizeof *places);
    if (tokens == NULL || places == NULL) {
        free(tokens);
        free(places);
        fail(s, "out of memory");
        return 0;
    }
    for (at = 0; at < queue->count; at++) {
        tokens[at] = queue->at[(queue->first + at) % queue->size];
        places[at] = queue->places[(queue->first + at) % queue->size];
    }
    s->bytes += bytes - (size_t)queue->size * (sizeof *queue->at + sizeof *queue->places);
    free(queue->at);
    free(queue->places);
    queue->at = tokens;
    queue->places = places;
    queue->size = size;
    queue->first = 0;
    return 1;
}

static void push(struct state *s, struct queue *queue, int place, struct value token)
{
    int at;
    if (queue->count == queue->size && !grow(s, queue)) {
        return;
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

/* What a token weighs where it waits. */
static inline double weight(struct value token) { return token.kind == LIST ? token.count + 1 : 1; }

static inline struct value takeWaiting(struct state *s, struct queue *queue)
{
    struct value token = take(queue);
    s->queued -= weight(token);
    return token;
}

static inline void waits(struct state *s, struct queue *queue, struct value token, int capacity, int policy)
{
    double weighs = weight(token);
    if (queue->count >= capacity || s->queued + weighs > QUEUED_MAX) {
        if (policy == 2) {
            fail(s, "too many tokens wait");
            return;
        }
        /* The oldest one is lost, or this one if none waits. */
        if (queue->count == 0) {
            return;
        }
        takeWaiting(s, queue);
    }
    s->queued += weighs;
    push(s, queue, 0, token);
}

static inline void post(struct state *s, int place, struct value token)
{
    if (s->tokens.count >= DELIVERIES_MAX) {
        fail(s, "too many tokens are on their way");
        return;
    }
    push(s, &s->tokens, place, token);
}

static inline void count(struct state *s)
{
    if (++s->firings > FIRINGS_MAX) {
        fail(s, "too many reactions in one instant, as in a cycle without a wait");
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
        reactions[place].run(s, token);
    }
}

static void instant(struct state *s, double now, int polls)
{
    s->now = now;
    s->firings = 0;
    fire(s);
    s->at = NULL;
    if (polls && s->fault == NULL) {
        poll(s);
    }
    deliver(s);
}

static void tuple(struct state *s, double passed, const uint8_t *in)
{
    double now;
    int left;
    s->at = NULL;
    if (s->us == 0) {
        s->us = POLL_MS * 1000.0;
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
    if (s->fault == NULL && !fields(s, out) && s->fault == NULL) {
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
