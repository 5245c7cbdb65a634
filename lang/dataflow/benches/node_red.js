// The chain of ten functions of `machine.rs` in Node-RED: tokens that come to its end, and what each takes at a block.
//
// usage: node node_red.js NODE_MODULES TOKENS
//
// NODE_MODULES has the package node-red. Prints nanoseconds for each token and block. Knows nothing of this project.
'use strict';
const fs = require('fs');
const http = require('http');
const os = require('os');
const path = require('path');

const [modules, tokens] = [path.resolve(process.argv[2]), Number(process.argv[3])];
const CHAIN = 10;
const RED = require(path.join(modules, 'node-red'));
const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'node-red-'));
let begun = 0n;
let come = 0;

const end = (code) => {
  fs.rmSync(folder, { recursive: true, force: true });
  process.exit(code);
};

const functions = {
  begin: () => {
    begun = process.hrtime.bigint();
  },
  arrive: () => {
    come += 1;
    if (come === tokens) {
      const took = Number(process.hrtime.bigint() - begun);
      console.log(took / tokens / (CHAIN + 1));
      end(0);
    }
  },
};

// A node without a place counts as a configuration of others.
const placed = { z: 'chain', x: 100, y: 100 };
const node = (id, func, to) => ({ id, type: 'function', ...placed, name: id, func, outputs: 1, wires: [to] });
const flow = [
  { id: 'chain', type: 'tab', label: 'chain' },
  { id: 'start', type: 'inject', ...placed, once: true, onceDelay: 0.5, repeat: '', props: [{ p: 'payload' }], payload: '0', payloadType: 'num', wires: [['spread']] },
  // As many as a poll of twenty sensors gives, then the rest of the program has its turn.
  node(
    'spread',
    `global.get('begin')();
     let sent = 0;
     const later = global.get('setImmediate');
     const poll = () => {
       for (let at = 0; at < 20 && sent < ${tokens}; at++, sent++) node.send({ payload: sent % 100 });
       if (sent < ${tokens}) later(poll);
     };
     poll();`,
    ['f0'],
  ),
];
for (let at = 0; at < CHAIN; at++) {
  flow.push(node(`f${at}`, 'msg.payload = msg.payload * 3 % 101;\nreturn msg;', [at + 1 < CHAIN ? `f${at + 1}` : 'end']));
}
flow.push(node('end', "global.get('arrive')();", []));

fs.writeFileSync(path.join(folder, 'flows.json'), JSON.stringify(flow));
const server = http.createServer(() => {});
RED.init(server, {
  userDir: folder,
  flowFile: 'flows.json',
  httpAdminRoot: false,
  httpNodeRoot: false,
  disableEditor: true,
  telemetry: { enabled: false },
  functionGlobalContext: { ...functions, setImmediate },
  logging: { console: { level: 'off', metrics: false, audit: false } },
});
RED.start().catch((error) => {
  console.error(String(error));
  end(1);
});
setTimeout(() => {
  console.error(`only ${come} of ${tokens} tokens came in two minutes`);
  end(1);
}, 120000);
