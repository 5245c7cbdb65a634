// Drives a square of 30 cm by its encoders: node square.js [TREE]
const fs = require('fs');
const { setTimeout: sleep } = require('timers/promises');

const tree = process.argv[2] || process.env.TRIK_TREE || '/trikfs';

// Degrees of a wheel of 56 mm for 300 mm ahead, and for a quarter of a turn with wheels 155 mm apart.
const side = 614;
const corner = 249;

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

function readWheels() {
  return { left: readNumber('encoders/left/value'), right: readNumber('encoders/right/value') };
}

// The power that brings a wheel nearer to its goal.
function powerFor(missing) {
  return Math.max(-30, Math.min(30, Math.trunc(missing / 5)));
}

// Turns the wheels by so many degrees. Goals grow from leg to leg, so small errors do not add up.
async function turnWheels(goal, leftDegrees, rightDegrees) {
  goal.left += leftDegrees;
  goal.right += rightDegrees;
  for (;;) {
    const now = readWheels();
    const leftPower = powerFor(goal.left - now.left);
    const rightPower = powerFor(goal.right - now.right);
    drive(leftPower, rightPower);
    if (leftPower === 0 && rightPower === 0) return;
    await sleep(20);
  }
}

async function main() {
  const goal = readWheels();
  for (let leg = 0; leg < 4; leg++) {
    await turnWheels(goal, side, side);
    await turnWheels(goal, -corner, corner);
  }
}

main();
