// Follows a dark line on a bright floor until Ctrl-C: node line.js [TREE]
const fs = require('fs');
const { setTimeout: sleep } = require('timers/promises');

const tree = process.argv[2] || process.env.TRIK_TREE || '/trikfs';

// Motors that stay open until the program ends come to rest then, also after Ctrl-C.
const leftMotor = fs.openSync(tree + '/motors/left/value', 'r+');
const rightMotor = fs.openSync(tree + '/motors/right/value', 'r+');

function drive(left, right) {
  fs.writeSync(leftMotor, String(left));
  fs.writeSync(rightMotor, String(right));
}

function readNumber(name) {
  return Number(fs.readFileSync(tree + '/' + name));
}

async function main() {
  for (;;) {
    // The sensors look at the floor beside the line; the one that sees the line has the larger number.
    const left = readNumber('sensors/floor_left/value');
    const right = readNumber('sensors/floor_right/value');
    const turn = Math.trunc((left - right) / 4);
    drive(20 - turn, 20 + turn);
    await sleep(20);
  }
}

main();
