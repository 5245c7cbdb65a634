// Goes to the wall ahead and stops 20 cm before it: node wall.js [TREE]
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
    try {
      const power = (readNumber('sensors/front/value') - 20) * 2;
      if (power === 0) break;
      const limited = Math.max(-30, Math.min(30, power));
      drive(limited, limited);
    } catch (error) {
      // No echo: nobody knows how far the wall is.
      drive(0, 0);
    }
    await sleep(20);
  }
  drive(0, 0);
}

main();
