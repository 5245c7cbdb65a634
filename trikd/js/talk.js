// gamepad, mailbox and Threading: what programs hear from outside.
(function (kit) {
'use strict';

const { native, Signal, emit, absent } = kit;

const LINES = 'gamepad/text/device';
const RELEASED = -101;
const latched = new Set();
const listen = () => native.listen(LINES, 0);
const signal = () => new Signal(listen);
let isHeard = false;

const wordsOf = (line) => line.split(' ').filter((word) => word !== '');
const isDown = (second) => second === undefined || second === 'down';
function note(line) {
    const [word, first, second, third] = wordsOf(line);
    const number = Number(first);
    if (word === 'btn') {
        if (isDown(second))
            latched.add(number);
        noted.set(`button ${number}`, isDown(second));
    } else if (word === 'pad')
        noted.set(`pad ${number}`, second === 'up' ? undefined : [Number(second), Number(third)]);
    else if (word === 'wheel')
        noted.set('wheel', number);
    notedAt = native.clock();
}
// The files of the tree follow the lines after some milliseconds: what has just been heard is newer.
const NEWER_MS = 500;
const noted = new Map();
let notedAt = -Infinity;
function newer(name, read) {
    newest();
    return noted.has(name) && native.clock() - notedAt < NEWER_MS ? noted.get(name) : read();
}
const pad = (number) => newer(`pad ${Number(number)}`, () => native.pad(Number(number)));

function tell(line) {
    const [word, first, second, third] = wordsOf(line);
    if (!isHeard) {
        isHeard = true;
        emit(gamepad.connected);
    }
    if (word === 'pad' && second === 'up')
        emit(gamepad.padUp, Number(first));
    else if (word === 'pad')
        emit(gamepad.pad, Number(first), Number(second), Number(third));
    else if (word === 'btn')
        emit(gamepad.button, Number(first), isDown(second) ? 1 : 0);
    else if (word === 'wheel')
        emit(gamepad.wheelEvent, Number(first));
    else if (word === 'custom')
        emit(gamepad.custom, line.slice(line.indexOf('custom') + 'custom'.length).trim());
}
const drain = kit.onRecord(LINES, note, tell);
function newest() {
    // Without its lines there are still its files.
    if (native.tryListen(LINES, 0))
        drain();
}
const DISCONNECT_LOOK_MS = 500;
const gamepad = kit.part({
    isPadPressed(number) { return pad(number) !== undefined; },
    padX(number) { return pad(number)?.[0] ?? RELEASED; },
    padY(number) { return pad(number)?.[1] ?? RELEASED; },
    wheel() { return newer('wheel', native.wheel); },
    buttonWasPressed(button) {
        listen();
        newest();
        return latched.delete(Number(button));
    },
    buttonIsPressed(button) { return newer(`button ${Number(button)}`, () => native.button(Number(button))); },
    isConnected() { return native.gamepadConnected(); },
    disconnect() { absent('gamepad.disconnect', 'a gamepad ends its connection itself; nothing is changed'); },
    reset() {
        newest();
        latched.clear();
    },
    pad: signal(),
    padUp: signal(),
    button: signal(),
    wheelEvent: signal(),
    custom: signal(),
    connected: signal(),
    disconnected: new Signal(() => {
        let was = native.gamepadConnected();
        const timer = new kit.Timer(DISCONNECT_LOOK_MS);
        timer.timeout.connect(() => {
            const is = native.gamepadConnected();
            if (was && !is) {
                isHeard = false;
                emit(gamepad.disconnected);
            }
            was = is;
        });
    }),
});
kit.hold('gamepad', gamepad);
// Files of newest values begin to listen when they are opened, so they are opened before they are needed.
if (native.mentions('gamepad')) {
    native.tryListen(LINES, 0);
    native.pad(1);
    native.pad(2);
    native.wheel();
    native.button(1);
}
if (native.mentions('keys'))
    native.tryListen('keys/device', 7);

let stopsWaiting = false;
const ask = (...words) => native.mailbox(kit.text(words.join(' ')));
const flag = (word) => ask(word) === '1';
const hull = kit.whole;
const address = (ip) => String(ip).trim() || '-';
const mailbox = kit.part({
    connect(ip, port = undefined) { ask('connect', address(ip), ...port === undefined ? [] : [hull(port)]); },
    joinNetwork(ip, port = -1, number = -1) { ask('join', address(ip), hull(port), hull(number)); },
    send(to, text = undefined) {
        if (text === undefined)
            ask('send', -1, kit.words(to));
        else
            ask('send', hull(to), kit.words(text));
    },
    receive(wait = true) {
        stopsWaiting = false;
        if (!wait)
            return native.takeMail() ?? '';
        return kit.until(() => stopsWaiting ? '' : native.takeMail());
    },
    hasMessages() { return native.hasMail(); },
    clearQueue() { while (native.takeMail() !== undefined); },
    stopWaiting() { stopsWaiting = true; },
    myHullNumber() { return Number(ask('hull')); },
    setHullNumber(number) { ask('hull', hull(number)); },
    serverIp() { return ask('server'); },
    hasServer() { return ask('server') !== ''; },
    myIp() { return ask('ip'); },
    isConnected() { return flag('connected'); },
    isEnabled() { return flag('enabled'); },
    renewIp() { ask('renew'); },
    newMessage: new Signal(),
});
kit.hold('mailbox', mailbox);
kit.onEvent('mail', (sender, text) => emit(mailbox.newMessage, sender, text));

// Plain values of a program's own variables, for a new thread: what holds functions or devices is made there anew.
function isPlain(value, depth) {
    if (value === null || ['boolean', 'number', 'string'].includes(typeof value))
        return true;
    if (typeof value !== 'object' || depth > 16)
        return false;
    const kind = Object.getPrototypeOf(value);
    return (kind === Object.prototype || kind === Array.prototype)
        && Object.values(value).every((part) => isPlain(part, depth + 1));
}
function plainGlobals() {
    const found = {};
    for (const name of Object.keys(globalThis)) {
        const { value } = Object.getOwnPropertyDescriptor(globalThis, name);
        if (isPlain(value, 0))
            found[name] = value;
    }
    return JSON.stringify(found);
}
kit.takeGlobals = (json) => { Object.assign(globalThis, JSON.parse(json)); };

const { text } = kit;
kit.hold('Threading', kit.part({
    startThread(id, called) {
        if (typeof called !== 'function') {
            native.startThread(text(id), plainGlobals(), text(`${called}();`));
            return;
        }
        const name = Object.keys(globalThis).find((key) => globalThis[key] === called);
        native.startThread(text(id), plainGlobals(), text(name ? `${name}();` : `(${called})();`));
    },
    joinThread(id) { kit.until(() => native.isRunning(text(id)) ? undefined : null); },
    killThread(id) { native.killThread(text(id)); },
    sendMessage(id, message) { native.sendMessage(text(id), text(message)); },
    receiveMessage(wait = true) {
        if (!wait)
            return native.takeMessage() ?? '';
        return kit.until(() => native.takeMessage());
    },
    reset() { native.killOthers(); },
}));
})
