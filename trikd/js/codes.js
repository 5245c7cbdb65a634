// Names of ports, keys and codes of input events (linux/input-event-codes.h).
(function (kit) {
'use strict';

const ports = ['F1', 'video1', 'video2'];
for (const [letters, count] of [['A', 6], ['T', 3], ['W', 4], ['D', 3], ['M', 4], ['B', 4], ['E', 4], ['C', 3], ['S', 6],
    ['SS', 14], ['TEMP_DHT11_', 14], ['TEMP_DHT22_', 14], ['HUM_DHT11_', 14], ['HUM_DHT22_', 14]]) {
    for (let number = 1; number <= count; number++)
        ports.push(letters + number);
}
for (let number = 1; number <= 7; number++) {
    for (let address = 0x11; address <= 0x20; address++)
        ports.push(`U${number}_0x${address.toString(16)}`);
}
for (const port of ports)
    kit.hold(port, port);

kit.hold('KeysEnum', { Left: 105, Up: 103, Down: 108, Enter: 28, Right: 106, Power: 116, Esc: 1 });
kit.hold('Events', { Sync: 0, Key: 1, Relative: 2, Absolute: 3, Misc: 4 });
// First the controller's own names, then those of the kernel, which earlier versions had here.
kit.hold('MouseEventCodes', {
    X: 0, Y: 1, Wheel: 8, LeftBtn: 272, RightBtn: 273, MiddleBtn: 274,
    HWheel: 6, Left: 272, Right: 273, Middle: 274, Side: 275, Extra: 276,
});
kit.hold('PadEventCodes', {
    BtnA: 304, BtnB: 305, BtnC: 306, BtnX: 307, BtnY: 308, BtnZ: 309,
    BtnTL: 310, BtnTR: 311, BtnTL2: 312, BtnTR2: 313, BtnSelect: 314, BtnStart: 315,
    X: 0, Y: 1, Z: 2, Rx: 3, Ry: 4, Rz: 5, Throttle: 6, Rudder: 7, Wheel: 8, Gas: 9, Break: 10,
    Hat0X: 16, Hat0Y: 17, Hat1X: 18, Hat1Y: 19,
    RX: 3, RY: 4, RZ: 5, South: 304, East: 305, North: 307, West: 308,
    TL: 310, TR: 311, TL2: 312, TR2: 313, Select: 314, Start: 315, Mode: 316, ThumbL: 317, ThumbR: 318,
});
})
