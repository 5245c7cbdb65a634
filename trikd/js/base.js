// What every engine begins with: signals, timers, the wait in which they happen, print and script.
//
// A function of `native`, the functions that the host gives (js/natives.rs). Everything that a program sees is a
// property of the global object that is not enumerable, so that enumerable ones are the program's own.
(function (native) {
'use strict';

const kit = { native };
const hold = (name, value) => Object.defineProperty(globalThis, name, { value, writable: true, configurable: true });
kit.hold = hold;

// A text as it may leave the engine: halves of characters are replaced.
const text = (value) => String(value).toWellFormed();
kit.text = text;

// Arguments as the controller's own engine takes them. A whole number is cut towards zero, and 0 is made of what is no
// number; beyond 32 bits it stays at their end, because a number that changes its sign would turn a robot around.
const LEAST = -(2 ** 31), MOST = 2 ** 31 - 1;
kit.whole = (value) => {
    const number = Number(value);
    return Number.isFinite(number) ? Math.max(LEAST, Math.min(MOST, Math.trunc(number))) + 0 : 0;
};
// Nothing is an empty text.
kit.words = (value) => value === undefined || value === null ? '' : text(value);

// The methods of a part of the robot: they keep their object when a program takes them off it, and say when arguments
// are missing. A method can do without those that have a usual value.
kit.part = (part) => {
    for (let level = part; level !== Object.prototype; level = Object.getPrototypeOf(level)) {
        for (const name of Object.getOwnPropertyNames(level)) {
            const { value } = Object.getOwnPropertyDescriptor(level, name);
            if (typeof value !== 'function' || name === 'constructor' || name.startsWith('_')
                || level !== part && Object.hasOwn(part, name))
                continue;
            const method = (...values) => {
                if (values.length < value.length)
                    throw new SyntaxError(`too few arguments in call to ${name}(): it takes ${value.length}`);
                return value.apply(part, values);
            };
            Object.defineProperty(part, name, { value: method, writable: true, enumerable: true, configurable: true });
        }
    }
    return part;
};

// A thing that the robot does not have: programs go on, and a person is told once.
const told = new Set();
kit.absent = (what, why) => {
    if (!told.has(what)) {
        told.add(what);
        native.info(text(`${what}: ${why}`));
    }
};
// The same where going on would need a value that nobody has.
kit.refuse = (what, why) => { throw new TypeError(`${what}: ${why}`); };

class Signal {
    // `started` is called before the first connection.
    constructor(started) {
        this._started = started;
        this._slots = [];
        kit.part(this);
    }
    _slot(first, second) {
        const [self, slot] = second === undefined ? [undefined, first] : [first, second];
        const called = typeof slot === 'string' && self ? self[slot] : slot;
        if (typeof called !== 'function')
            throw new TypeError('Function.prototype.connect: target is not a function');
        return { self, called };
    }
    connect(first, second = undefined) {
        const slot = this._slot(first, second);
        if (this._started) {
            this._started();
            this._started = undefined;
        }
        this._slots.push(slot);
    }
    disconnect(first = undefined, second = undefined) {
        if (first === undefined) {
            this._slots = [];
            return;
        }
        const slot = this._slot(first, second);
        const index = this._slots.findIndex((other) => other.self === slot.self && other.called === slot.called);
        if (index < 0)
            throw new TypeError('Function.prototype.disconnect: the function is not connected');
        this._slots.splice(index, 1);
    }
}
kit.Signal = Signal;
kit.emit = (signal, ...values) => {
    for (const slot of [...signal._slots])
        slot.called.apply(slot.self, values);
};
// A signal that would never come says so when somebody wants it.
kit.never = (what, why) => new Signal(() => kit.refuse(what, why));

const timers = new Set();
class Timer {
    constructor(ms) {
        this.timeout = new Signal();
        this.singleShot = false;
        this.interval = 0;
        this._due = Infinity;
        this._busy = false;
        kit.part(this);
        this.start(ms);
    }
    get active() { return timers.has(this); }
    isActive() { return this.active; }
    setInterval(ms) {
        this.interval = Math.max(0, kit.whole(ms));
        if (this.active)
            this._due = native.clock() + this.interval;
    }
    setSingleShot(on) { this.singleShot = Boolean(on); }
    start(ms = undefined) {
        if (ms !== undefined)
            this.interval = Math.max(0, kit.whole(ms));
        if (!this.active && timers.size >= native.timersMax)
            throw new RangeError(`more than ${native.timersMax} timers: stop those that are no longer needed`);
        timers.add(this);
        this._due = native.clock() + this.interval;
    }
    stop() { timers.delete(this); }
}
kit.Timer = Timer;
function fire(timer) {
    if (timer.singleShot)
        timer.stop();
    // A period of 0 is one of 1 ms: others want to run as well.
    timer._due = Math.max(native.clock(), timer._due + Math.max(1, timer.interval));
    // Its own function may wait, and is not entered twice.
    timer._busy = true;
    try {
        kit.emit(timer.timeout);
    } finally {
        timer._busy = false;
    }
}

// Functions by the source of what happened.
const sources = new Map();
kit.onEvent = (source, handler) => { sources.set(source, handler); };

// What a stream has brought is noted at once, also when a program asks; functions that are connected are called only
// while it waits, one event after the other.
const pending = [], PENDING_MAX = 1024;
kit.onRecord = (source, note, tell) => {
    sources.set(source, (record) => {
        note(record);
        tell(record);
    });
    return () => {
        for (const record of native.drain(source)) {
            note(record);
            pending.push(() => tell(record));
        }
        pending.splice(0, pending.length - PENDING_MAX);
    };
};

// Until a time of native.clock(): at most one event and one timer, whatever comes first; also returns when something
// may have changed that was waited for.
function step(until) {
    let next = null;
    for (const timer of timers) {
        if (!timer._busy && (next === null || timer._due < next._due))
            next = timer;
    }
    const due = next === null ? until : Math.min(until, next._due);
    const event = native.next(pending.length > 0 ? 0 : due);
    if (pending.length > 0) {
        // Those came before the event.
        if (event !== null)
            pending.push(() => sources.get(event[0])?.(event[1], event[2]));
        pending.shift()();
    } else if (event !== null) {
        const handler = sources.get(event[0]);
        if (handler)
            handler(event[1], event[2]);
    }
    if (next !== null && timers.has(next) && !next._busy && next._due <= native.clock())
        fire(next);
}
kit.step = step;
kit.wait = (ms) => {
    const end = native.clock() + Math.max(0, kit.whole(ms));
    do step(end); while (native.clock() < end);
};
// Until the condition gives something.
kit.until = (condition) => {
    for (;;) {
        const value = condition();
        if (value !== undefined)
            return value;
        step(Infinity);
    }
};

function printed(value) {
    return Array.isArray(value) ? `[${value.map(printed).join(', ')}]` : String(value);
}
// Where time is not that of the world, neither are the calendar and chance.
if (native.date() !== undefined) {
    const Real = Date;
    const Virtual = function Date(...values) {
        const date = values.length > 0 ? new Real(...values) : new Real(native.date());
        return new.target ? date : String(date);
    };
    Virtual.prototype = Real.prototype;
    Virtual.prototype.constructor = Virtual;
    Object.assign(Virtual, { now: native.date, parse: Real.parse, UTC: Real.UTC });
    hold('Date', Virtual);
    const MOST = 2 ** 30;
    Math.random = () => native.random(0, MOST - 1) / MOST;
    hold('performance', { now: native.clock, timeOrigin: native.date() });
}

hold('print', (...values) => native.print(text(values.map(printed).join('') + '\n')));
hold('include', (file) => native.include(text(file)));

// A small picture of the camera, one number for each point.
const PHOTO = [160, 120];
const getPhoto = () => {
    const rgb = native.photo(...PHOTO), points = [];
    for (let at = 0; at < rgb.length; at += 3)
        points.push(rgb[at] << 16 | rgb[at + 1] << 8 | rgb[at + 2]);
    return points;
};
hold('getPhoto', getPhoto);

hold('script', kit.part({
    wait(ms) { kit.wait(ms); },
    time() { return Date.now(); },
    timeInterval(first, second) { return (kit.whole(second) - kit.whole(first)) & 0x7fffffff; },
    random(a, b) {
        const [first, second] = [kit.whole(a), kit.whole(b)];
        const least = Math.min(first, second), most = Math.max(first, second);
        const drawn = native.random(least, most);
        if (drawn !== undefined)
            return drawn;
        return least + Math.floor(Math.random() * (most - least + 1));
    },
    timer(ms) { return new Timer(ms); },
    repeat(ms, called) {
        const timer = new Timer(ms);
        timer.timeout.connect(called);
        return timer;
    },
    run() { native.run(); },
    quit() { native.quit(); },
    system(command, synchronously = false) { return native.system(text(command), Boolean(synchronously)); },
    writeToFile(file, what) { native.append(text(file), kit.words(what)); },
    writeData(file, bytes) { native.appendBytes(text(file), Array.from(bytes, (byte) => byte & 0xff)); },
    readAll(file) { return native.readAll(text(file)); },
    removeFile(file) { native.remove(text(file)); },
    getPhoto,
    reset() { timers.clear(); },
}));

Object.defineProperty(String.prototype, 'format', {
    value(...values) {
        return this.replace(/\{(\d+)\}/g, (match, index) => values[index] === undefined ? match : values[index]);
    },
    writable: true,
    configurable: true,
});

// Variables for web pages, all as texts.
hold('web', {});
kit.onEvent('web', () => {
    const shown = {};
    for (const name in Object(globalThis.web))
        shown[name] = printed(globalThis.web[name]);
    native.web(text(JSON.stringify(shown)));
});
kit.onEvent('direct', native.direct);

// For ever; ends when native.next() throws because the program ends, or when a function of a program fails.
kit.loop = (survives) => {
    for (;;) {
        try {
            step(Infinity);
        } catch (error) {
            if (!survives || !native.survive(error))
                throw error;
        }
    }
};
return kit;
})
