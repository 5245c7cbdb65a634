// brick: the robot by the names of its ports.
(function (kit) {
'use strict';

const { native, Signal, emit, absent, refuse, never } = kit;
const { text, whole, part } = kit;
const port = kit.words;

// An object for each port; null where nothing is plugged in, which is told once and asked again the next time: what is
// called on null is an error that names no port.
function plugged(what, groups, find, make) {
    const known = new Map();
    return (name) => {
        const found = known.get(name);
        if (found !== undefined)
            return found;
        const handle = find(port(name));
        if (handle < 0) {
            const there = groups.flatMap((group) => native.ports(group)).join(', ') || 'none';
            absent(`brick.${what}(${port(name)})`, `nothing is plugged in there; plugged in are ${there}`);
            return null;
        }
        const made = part(make(handle));
        known.set(name, made);
        return made;
    };
}

class Motor {
    constructor(handle) { this._handle = handle; }
    setPower(power, constrain = true) {
        const number = Number(power);
        if (!Number.isFinite(number))
            absent('motor.setPower', `${text(power)} is no number: a motor stands still, a servo stays where it is`);
        native.motorSet(this._handle, Number.isFinite(number) ? whole(number) : NaN);
    }
    power() { return native.motorGet(this._handle); }
    powerOff() { native.motorOff(this._handle); }
    brake(ms = 500) {
        native.motorBrake(this._handle);
        kit.wait(ms);
        native.motorOff(this._handle);
    }
    setPeriod() { absent('motor.setPeriod', 'the tree sets the period of pulses by the type of the motor; nothing is changed'); }
}

class Sensor {
    constructor(handle) { this._handle = handle; }
    read() { return native.sensorRead(this._handle); }
    readRawData() { return native.sensorRaw(this._handle); }
}

class Encoder {
    constructor(handle) { this._handle = handle; }
    read() { return native.encoderRead(this._handle); }
    readRawData() { return native.encoderRaw(this._handle); }
    reset() { native.encoderReset(this._handle); }
}

// Values of a sensor that is looked at 50 times a second while somebody is connected.
const LOOK_MS = 20;
function watched(read) {
    const signal = new Signal(() => {
        const timer = new kit.Timer(LOOK_MS);
        timer.timeout.connect(() => emit(signal, read(), Date.now()));
    });
    return signal;
}

const accelerometer = part({
    read() { return native.vector('accelerometer'); },
    readRawData() { return native.vectorRaw('accelerometer'); },
});
accelerometer.newData = watched(accelerometer.read);

const HALF_TURN = 180000, HEADING = 6;
const NO_CALIBRATION = 'the gyroscope calibrates itself whenever the robot rests; its bias stands in the robot file';
let forward = 0, calibratedAt = 0;
const gyroscope = part({
    read() {
        const values = native.vector('gyroscope');
        const turned = values[HEADING] - forward;
        values[HEADING] = turned - 2 * HALF_TURN * Math.round(turned / (2 * HALF_TURN));
        return values;
    },
    readRawData() { return native.vectorRaw('gyroscope'); },
    // The tree measures the bias by itself; what is left is where forward is.
    calibrate(ms) {
        const timer = new kit.Timer(ms);
        calibratedAt = native.clock() + timer.interval;
        timer.singleShot = true;
        timer.timeout.connect(() => {
            forward = native.vector('gyroscope')[HEADING];
            emit(gyroscope.calibrationFinished);
        });
    },
    isCalibrated() {
        if (native.clock() < calibratedAt)
            return false;
        return native.isReady('gyroscope');
    },
    getCalibrationValues() { return refuse('gyroscope.getCalibrationValues', NO_CALIBRATION); },
    setCalibrationValues(values) { return refuse('gyroscope.setCalibrationValues', NO_CALIBRATION); },
    calibrationFinished: new Signal(),
});
gyroscope.newData = watched(() => gyroscope.read());

const KEY_ORDER = [116, 103, 1, 105, 106, 108, 28];
const KEYS_DEVICE = 'keys/device';
const keyState = KEY_ORDER.map(() => 0), latched = new Set(), codes = [], CODES_MAX = 64;
const toldState = [...keyState];
function changed(state, values, happened) {
    values.forEach((value, index) => {
        if (value !== state[index]) {
            state[index] = value;
            happened(KEY_ORDER[index], value);
        }
    });
}
function press(code, value) {
    if (value) {
        latched.add(code);
        codes.push(code);
        codes.splice(0, codes.length - CODES_MAX);
    }
}
const drainKeys = kit.onRecord(KEYS_DEVICE,
    (values) => changed(keyState, values, press),
    (values) => changed(toldState, values, (code, value) => emit(keys.buttonPressed, code, value)));
const listenToKeys = () => native.listen(KEYS_DEVICE, KEY_ORDER.length);
function newestKeys() {
    listenToKeys();
    drainKeys();
}
const keys = part({
    buttonPressed: new Signal(listenToKeys),
    wasPressed(code) {
        newestKeys();
        return latched.delete(Number(code));
    },
    isPressed(code) { return native.keyPressed(Number(code)); },
    buttonCode(wait = true) {
        newestKeys();
        if (wait)
            kit.until(() => codes.length > 0 || undefined);
        return codes.length > 0 ? codes.shift() : -1;
    },
    reset() {
        newestKeys();
        latched.clear();
        codes.length = 0;
    },
});

const led = part({
    red() { native.led(false, true); },
    green() { native.led(true, false); },
    orange() { native.led(true, true); },
    off() { native.led(false, false); },
});
const battery = part({
    readVoltage() { return native.voltage(); },
    readRawDataVoltage() { return native.rawVoltage(); },
});

// What goes wrong on the display is told once and never ends a program.
const draw = (name, reason) => {
    if (reason)
        absent(`display.${name}`, reason);
};
const order = (name, verb, ...words) => draw(name, native.draw(text([verb, ...words].join(' '))));
const display = part({
    addLabel(label, x, y, height = -1) {
        order('addLabel', 'label', whole(x), whole(y), whole(height), kit.words(label).replaceAll('\n', '\\n'));
    },
    removeLabels() { order('removeLabels', 'removelabels'); },
    showImage(file) { draw('showImage', native.showFile(text(file))); },
    show(pixels, width, height, format = 'rgb32') {
        draw('show', native.showNumbers(Array.from(pixels, (pixel) => pixel | 0), whole(width), whole(height), text(format)));
    },
    drawLine(x1, y1, x2, y2) { order('drawLine', 'line', ...[x1, y1, x2, y2].map(whole)); },
    drawPoint(x, y) { order('drawPoint', 'point', whole(x), whole(y)); },
    drawRect(x, y, width, height, filled = false) {
        order('drawRect', 'rect', ...[x, y, width, height].map(whole), Number(Boolean(filled)));
    },
    drawEllipse(x, y, width, height, filled = false) {
        order('drawEllipse', 'ellipse', ...[x, y, width, height].map(whole), Number(Boolean(filled)));
    },
    drawArc(x, y, width, height, start, span) { order('drawArc', 'arc', ...[x, y, width, height, start, span].map(whole)); },
    setPainterColor(name) { order('setPainterColor', 'color', kit.words(name)); },
    setPainterWidth(pixels) { order('setPainterWidth', 'width', whole(pixels)); },
    setBackground(color) { order('setBackground', 'background', kit.words(color)); },
    redraw() { order('redraw', 'redraw'); },
    clear() { order('clear', 'clear'); },
    hide() { order('hide', 'hide'); },
    reset() { order('reset', 'clear'); },
});

// Part of a stop, where there is a display.
const darken = () => {
    if (native.isFile('display/device'))
        order('hide', 'hide');
};

const DETECT_MS = 3000, DETECT_LOOK_MS = 20;
class Camera {
    constructor(name) {
        this._name = name;
        this.stopped = new Signal();
    }
    init(show = false) { native.cameraStart(this._name, Boolean(show)); }
    stop() {
        native.cameraStop(this._name);
        emit(this.stopped);
    }
    read() { return native.cameraRead(this._name); }
}
class Detector extends Camera {
    // Measures the colour in the middle of the picture and looks for it from then on.
    detect() {
        const before = String(this.getDetectParameters());
        let end = native.clock() + DETECT_MS;
        let measured = [];
        // Behind init() the sensor needs a while until it hears; then it has the whole time for its answer.
        let heard = false;
        while (native.clock() < end) {
            if (!heard && native.cameraDetect(this._name)) {
                heard = true;
                end = native.clock() + DETECT_MS;
            }
            kit.wait(DETECT_LOOK_MS);
            measured = this.getDetectParameters();
            if (String(measured) !== before)
                break;
        }
        if (measured.length === 0)
            throw new Error(`${this._name} sensor: no answer to detect() in ${DETECT_MS} ms: was init() called before?`);
        native.cameraLookFor(this._name, measured);
    }
    getDetectParameters() { return native.cameraDetected(this._name); }
}
const cell = (values, row, column, what) => {
    const side = Math.round(Math.sqrt(values.length));
    [row, column] = [whole(row), whole(column)];
    if (!(row >= 1 && row <= side && column >= 1 && column <= side))
        throw new RangeError(`${what} has cells 1 to ${side}, not ${row}, ${column}`);
    return values[(row - 1) * side + column - 1];
};
class Colors extends Camera {
    read(row = 1, column = 1) {
        const values = native.cameraRead(this._name);
        const color = values.length < 4 ? 0 : cell(values, row, column, 'colorSensor');
        return [color >> 16 & 255, color >> 8 & 255, color & 255];
    }
}
const cameras = new Map();
const camera = (name, Kind) => () => {
    if (!cameras.has(name) && native.hasCamera(name))
        cameras.set(name, part(new Kind(name)));
    return cameras.get(name) ?? null;
};

const values = (node) => native.numbers(`${node}/value`);
const NO_PICTURE = 'the tree has no picture of the infrared camera; readSensor() gives its cells';
// Three numbers for each point.
const STILL = [320, 240];
const irCamera = part({
    init() { values('ir_camera'); },
    stop() {},
    readSensor(row, column) { return cell(values('ir_camera'), row, column, 'irCamera'); },
    getImage() { return refuse('irCamera.getImage', NO_PICTURE); },
    imageUpdated: never('irCamera.imageUpdated', NO_PICTURE),
    sensorUpdated: never('irCamera.sensorUpdated', 'the tree tells no changes of the infrared camera; use a timer'),
    stopped: never('irCamera.stopped', 'the infrared camera does not stop'),
});
const lidar = part({ read() { return values('lidar'); } });

class Fifo {
    constructor(path) {
        this._lines = [];
        this.newLine = new Signal();
        this.newData = new Signal();
        this._newest = kit.onRecord(path, (line) => this._lines.push(line), (line) => {
            emit(this.newLine, line);
            emit(this.newData, Array.from(line, (character) => character.charCodeAt(0)));
        });
        native.listen(path, 0);
        part(this);
    }
    read() {
        this._newest();
        return kit.until(() => this._lines.shift());
    }
    readRaw() {
        this._newest();
        return Array.from(this._lines.splice(0).join('\n'), (character) => character.charCodeAt(0));
    }
    hasLine() {
        this._newest();
        return this._lines.length > 0;
    }
    hasData() { return this.hasLine(); }
}
const fifos = new Map();

// A servo port that the robot file makes a measuring one.
const measures = (name) => native.isFile(`servos/${name}/duty_cycle`);
class PwmCapture {
    constructor(name) {
        this._node = `servos/${name}`;
        part(this);
    }
    frequency() { return native.numbers(`${this._node}/raw`); }
    duty() { return native.numbers(`${this._node}/duty_cycle`)[0]; }
    dutyRaw() { return refuse('pwmCapture.dutyRaw', 'the driver tells no raw width of pulses; duty() gives percent'); }
}

// A device on a bus: bytes at the position of a register, as the tree has them.
const WIDE = 2 ** 24, REGISTERS = 2 ** 16, BYTES_MAX = 8192;
class I2c {
    // Words go out as `high` says, but come in with the low byte first, as TRIK has it.
    constructor(bus, address, wide, high) {
        this._path = `i2c/bus${bus}/device`;
        this._base = address * REGISTERS + (wide ? WIDE : 0);
        this._high = high;
        if (!native.isFile(this._path))
            throw new RangeError(`there is no bus ${bus}: the tree has no i2c/bus${bus}`);
        part(this);
    }
    _place(register) {
        const most = this._base >= WIDE ? 0xffff : 0xff;
        if (!(register >= 0 && register <= most && Number.isInteger(register)))
            throw new RangeError(`register ${register} is not 0 to ${most}`);
        return this._base + register;
    }
    send(register, value, mode = 'b') {
        const low = value & 255, high = value >> 8 & 255;
        const word = this._high ? [high, low] : [low, high];
        native.writeAt(this._path, this._place(Number(register)), mode === 'w' ? word : [low]);
    }
    read(register, mode = 'b') {
        const bytes = this.readX(register, mode === 'w' ? 2 : 1);
        return bytes[0] + (mode === 'w' ? bytes[1] * 256 : 0);
    }
    readX(register, count) {
        if (!(count >= 1 && count <= BYTES_MAX && Number.isInteger(count)))
            throw new RangeError(`${count} bytes are not 1 to ${BYTES_MAX}`);
        return native.readAt(this._path, this._place(Number(register)), count);
    }
}
const busNumber = (bus) => Math.trunc(Number(bus));
const busAddress = (address) => {
    if (!(address >= 3 && address <= 0x77 && Number.isInteger(address)))
        throw new RangeError(`address ${address} is not 3 to 119 (0x77)`);
    return address;
};

// The events of one input device, of one type of them, of one code of these.
const EVENT_NUMBERS = 4;
const NOT_NAME = /[^A-Za-z0-9_-]/g;
class EventCode {
    constructor() { this.on = new Signal(); }
}
class EventType {
    constructor() {
        this.on = new Signal();
        this._codes = new Map();
        part(this);
    }
    code(code) {
        code = Number(code);
        if (!this._codes.has(code))
            this._codes.set(code, new EventCode());
        return this._codes.get(code);
    }
}
class EventDevice {
    constructor(path) {
        this._types = new Map();
        this.on = new Signal();
        kit.onRecord(path, () => {}, ([kind, value, low, high]) => this._tell(kind & 0xffff, kind >>> 16, value,
            high * 2 ** 32 + (low >>> 0)));
        native.listen(path, EVENT_NUMBERS);
        part(this);
    }
    _tell(type, code, value, time) {
        emit(this.on, type, code, value, time);
        const types = this._types.get(type);
        if (types !== undefined) {
            emit(types.on, code, value, time);
            const codes = types._codes.get(code);
            if (codes !== undefined)
                emit(codes.on, value, time);
        }
    }
    onEvent(type) {
        type = Number(type);
        if (!this._types.has(type))
            this._types.set(type, new EventType());
        return this._types.get(type);
    }
}
const eventDevices = new Map();
const eventNode = (file) => `input/${text(file).replace(/.*\//, '').replace(NOT_NAME, '_')}`;

class Sound extends Camera {
    detect() {
        if (!native.cameraDetect(this._name))
            throw new Error('sound sensor: it does not run: was init() called before?');
    }
    volume(coefficient) { native.write('microphones/volume', `${Math.max(0, Math.min(100, whole(coefficient)))}\n`); }
}

const marker = part({
    _down: false,
    down(color = 'black') {
        native.mark(text(color));
        marker._down = true;
    },
    up() {
        native.mark('');
        marker._down = false;
    },
    isDown() { return marker._down; },
    setDown(on) { on ? marker.down() : marker.up(); },
});
const TONE_HZ = [20, 7000], TONE_MS_MAX = 10000;
const configurable = ['lineSensor', 'objectSensor', 'colorSensor'];
kit.hold('brick', part({
    motor: plugged('motor', ['motors', 'servos'], native.motor, (handle) => new Motor(handle)),
    sensor: plugged('sensor', ['sensors'], native.sensor, (handle) => new Sensor(handle)),
    encoder: plugged('encoder', ['encoders'], native.encoder, (handle) => new Encoder(handle)),
    keys() { return keys; },
    display() { return display; },
    led() { return led; },
    battery() { return battery; },
    accelerometer() { return native.has('accelerometer') ? accelerometer : null; },
    gyroscope() { return native.has('gyroscope') ? gyroscope : null; },
    lineSensor: camera('line', Detector),
    objectSensor: camera('object', Detector),
    colorSensor: camera('color', Colors),
    soundSensor: camera('sound', Sound),
    lidar() { return native.has('lidar') ? lidar : null; },
    irCamera() { return native.has('ir_camera') ? irCamera : null; },
    getStillImage() { return native.photo(...STILL); },
    pwmCapture(name) { return measures(text(name)) ? new PwmCapture(text(name)) : null; },
    fifo(name) {
        const path = `${port(name)}/device`;
        if (!fifos.has(path) && native.isNode(port(name)))
            fifos.set(path, new Fifo(path));
        return fifos.get(path) ?? null;
    },
    eventDevice(file) {
        const node = eventNode(file);
        if (!eventDevices.has(node) && native.has(node))
            eventDevices.set(node, new EventDevice(`${node}/device`));
        return eventDevices.get(node) ?? null;
    },
    stopEventDevice(file) {
        const node = eventNode(file);
        if (eventDevices.delete(node))
            native.forget(`${node}/device`);
    },
    i2c(bus, address, registerBytes = 1) {
        return new I2c(busNumber(bus), busAddress(Number(address)), Number(registerBytes) === 2, true);
    },
    smBusI2c(bus, address) { return new I2c(busNumber(bus), busAddress(Number(address)), false, false); },
    gamepad() { return globalThis.gamepad; },
    marker() { return native.has('marker') ? marker : null; },
    configure(name, type) {
        if (!configurable.includes(type))
            absent(`brick.configure of ${name}`, 'the robot file says what is plugged in; nothing is changed');
    },
    playSound(file) { native.playSound(kit.text(file)); },
    playTone(hz, ms) {
        [hz, ms] = [whole(hz), whole(ms)];
        if (hz >= 0 && ms > 0)
            native.tone(Math.max(TONE_HZ[0], Math.min(TONE_HZ[1], hz)), Math.min(TONE_MS_MAX, ms));
    },
    say(words) { native.say(kit.words(words)); },
    stop() {
        native.stop();
        darken();
        emit(this.stopped);
    },
    reset() {
        native.stop();
        darken();
        keys.reset();
        emit(this.resetCompleted);
    },
    motorPorts(type = undefined) {
        const all = { powerMotor: ['motors'], servoMotor: ['servos'] }[type] ?? ['motors', 'servos'];
        return all.flatMap((group) => native.ports(group));
    },
    sensorPorts(type = undefined) {
        const begins = { analogSensor: 'A', digitalSensor: 'D', rangeSensor: 'D' }[type] ?? '';
        return native.ports('sensors').filter((name) => name.startsWith(begins));
    },
    encoderPorts() { return native.ports('encoders'); },
    pwmCapturePorts() { return native.ports('servos').filter(measures); },
    smile() { order('smile', 'smile'); },
    sadSmile() { order('sadSmile', 'sadsmile'); },
    stopped: new Signal(),
    resetCompleted: new Signal(),
}));
})
