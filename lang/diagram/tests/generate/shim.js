// The robot for generated JavaScript: each call is a line to the test, which holds the stand-in and says who runs.
'use strict';
const fs = require('fs');
const vm = require('vm');
const { Worker, isMainThread, workerData } = require('worker_threads');

const THREADS = 64;
const turns = isMainThread ? new Int32Array(new SharedArrayBuffer(4 * THREADS)) : workerData.turns;
const counter = isMainThread ? new Int32Array(new SharedArrayBuffer(4)) : workerData.counter;
const me = isMainThread ? 0 : workerData.number;
const file = isMainThread ? process.argv[2] : workerData.file;

function say(...words) {
    const escaped = words.map(word => String(word).replace(/\\/g, '\\\\').replace(/\t/g, '\\t').replace(/\n/g, '\\n'));
    fs.writeSync(1, escaped.join('\t') + '\n');
}

function line() {
    const bytes = [];
    const one = Buffer.alloc(1);
    for (;;) {
        if (fs.readSync(0, one) === 0)
            process.kill(process.pid, 'SIGKILL');
        if (one[0] === 10)
            return Buffer.from(bytes).toString();
        bytes.push(one[0]);
    }
}

function ask(...words) {
    say(...words);
    return line();
}

function hand(answer) {
    if (answer === 'quit')
        process.kill(process.pid, 'SIGKILL');
    Atomics.store(turns, Number(answer), 1);
    Atomics.notify(turns, Number(answer));
}

function sleep() {
    Atomics.wait(turns, me, 0);
    Atomics.store(turns, me, 0);
}

// Gives the turn to whom the test names, and waits for it.
function turn(...words) {
    hand(ask(...words));
    sleep();
}

const numbers = text => text === '' ? [] : text.split(' ').map(Number);
const vector = (port, mode) => ({
    read: () => numbers(ask('vector', port)),
    init: show => say('camera', mode, Number(show)),
    detect: () => say('detect', mode),
    calibrate: () => say('calibrate'),
});

globalThis.brick = {
    motor: port => ({
        setPower: power => say(port[0] === 'M' ? 'power' : 'servo', port, power),
        powerOff: () => say('off', port),
    }),
    sensor: port => ({ read: () => Number(ask('scalar', port)) }),
    encoder: port => ({ read: () => Number(ask('scalar', port)), reset: () => say('reset', port) }),
    keys: () => ({
        isPressed: code => ask('key', code) !== '0',
        buttonCode: wait => {
            for (;;) {
                script.wait(20);
                const code = Number(ask('anykey'));
                if (code !== -1 || !wait)
                    return code;
            }
        },
    }),
    led: () => ({
        red: () => say('led', 'red'), green: () => say('led', 'green'),
        orange: () => say('led', 'orange'), off: () => say('led', 'off'),
    }),
    display: () => ({
        addLabel: (text, x, y, size) => say('label', x, y, size, text),
        redraw: () => say('redraw'),
        clear: () => say('clear'),
        setPainterColor: color => say('pen', color),
        setPainterWidth: width => say('width', width),
        setBackground: color => say('background', color),
        drawPoint: (...all) => say('pixel', ...all),
        drawLine: (...all) => say('line', ...all),
        drawRect: (...all) => say('rectangle', ...all.map(Number)),
        drawEllipse: (...all) => say('ellipse', ...all.map(Number)),
        drawArc: (...all) => say('arc', ...all),
    }),
    marker: () => ({ down: color => say('marker', color), up: () => say('markerup') }),
    gyroscope: () => vector('GyroscopePort'),
    accelerometer: () => vector('AccelerometerPort'),
    lidar: () => vector('LidarPort'),
    lineSensor: () => vector('LineSensorPort', 'line'),
    colorSensor: () => vector('ColorSensorPort', 'color'),
    objectSensor: () => ({
        ...vector('', 'object'),
        read: () => ['X', 'Y', 'Size'].map(part => Number(ask('scalar', 'ObjectSensor' + part + 'Port'))),
    }),
    smile: () => say('smile', 0),
    sadSmile: () => say('smile', 1),
    playSound: file => say('sound', file),
    playTone: (hertz, ms) => say('tone', hertz, ms),
    say: text => say('say', text),
    stop: () => say('rest'),
};

const scalar = name => Number(ask('scalar', name));
globalThis.gamepad = {
    buttonIsPressed: number => scalar('GamepadButton' + number + 'Port') !== 0,
    isPadPressed: number => scalar('GamepadPad' + number + 'PressedPort') !== 0,
    padX: number => numbers(ask('vector', 'GamepadPad' + number + 'PosPort'))[0],
    padY: number => numbers(ask('vector', 'GamepadPad' + number + 'PosPort'))[1],
    wheel: () => scalar('GamepadWheelPort'),
    isConnected: () => scalar('GamepadConnectionIndicatorPort') !== 0,
};

globalThis.script = {
    wait: ms => turn('wait', me, ms),
    time: () => Number(ask('time')),
    random: (low, high) => Number(ask('random', low, high)),
    system: command => say('system', command),
    writeToFile: (file, text) => say('append', file, text),
    removeFile: file => say('remove', file),
};

globalThis.Threading = {
    startThread: (name, called) => {
        const number = Atomics.add(counter, 0, 1) + 1;
        new Worker(__filename, { workerData: { turns, counter, number, file, called } });
        turn('start', me, number, name);
    },
    joinThread: name => turn('join', me, name),
    killThread: name => turn('kill', me, name),
    sendMessage: (name, text) => turn('send', me, name, text),
    receiveMessage: wait => {
        if (wait)
            turn('receive', me);
        return ask('message', me);
    },
};
globalThis.print = text => say('print', text);
for (const [letter, count] of [['A', 6], ['D', 2], ['M', 4], ['E', 4], ['S', 6]])
    for (let number = 1; number <= count; number++)
        globalThis[letter + number] = letter + number;

vm.runInThisContext(fs.readFileSync(file, 'utf8'), { filename: file });
if (!isMainThread)
    sleep();
globalThis[isMainThread ? 'main' : workerData.called]();
hand(ask('end', me));
Atomics.wait(new Int32Array(new SharedArrayBuffer(4)), 0, 0);
