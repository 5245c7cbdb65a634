// A debugged diagram by the client that debug adapters are tested with, over standard streams and over TCP; a program of data
// flow; and programs in Python and JavaScript on a virtual robot, if TRIK_DEBUGPY_PYTHON names the python3 of an environment that has debugpy.
//
// usage: node test/debug.js TRIK
"use strict";

const assert = require("assert");
const { spawn } = require("child_process");
const fs = require("fs");
const os = require("os");
const path = require("path");
const { DebugClient } = require("@vscode/debugadapter-testsupport");

const program = path.join(__dirname, "texts", "count.qrs");

async function talk(client) {
  client.defaultTimeout = PATIENCE;
  const caps = await client.initializeRequest();
  assert.ok(caps.body.supportsStepBack && caps.body.supportsLogPoints && caps.body.supportsDataBreakpoints && caps.body.supportsRestartRequest);
  const initialized = client.waitForEvent("initialized");
  await client.launch({ program, stopOnEntry: true });
  await initialized;
  const set = await client.setBreakpointsRequest({
    source: { path: program },
    breakpoints: [{ line: 4, condition: "n == 2" }, { line: 7 }],
  });
  assert.deepStrictEqual(set.body.breakpoints.map((one) => one.verified), [true, false]);
  const named = await client.setFunctionBreakpointsRequest({ breakpoints: [{ name: "nothing" }] });
  assert.strictEqual(named.body.breakpoints[0].verified, false);
  await client.setExceptionBreakpointsRequest({ filters: ["errors"] });
  let stopped = client.waitForEvent("stopped");
  await client.configurationDoneRequest();
  assert.strictEqual((await stopped).body.reason, "entry");

  // Each request that moves the program, and the line where it stops.
  const threadId = 1;
  const moves = async (request, line) => {
    stopped = client.waitForEvent("stopped");
    await request({ threadId });
    await stopped;
    const stack = await client.stackTraceRequest({ threadId });
    assert.strictEqual(stack.body.stackFrames[0].line, line, JSON.stringify(stack.body));
    return stack.body;
  };
  await moves((args) => client.continueRequest(args), 4);
  await moves((args) => client.nextRequest(args), 5);
  const inside = await moves((args) => client.stepInRequest(args), 9);
  assert.strictEqual(inside.totalFrames, 2);
  await moves((args) => client.stepOutRequest(args), 6);
  await moves((args) => client.stepBackRequest(args), 5);
  await moves((args) => client.customRequest("reverseContinue", args), 4);

  const threads = await client.threadsRequest();
  assert.deepStrictEqual(threads.body.threads, [{ id: 1, name: "main" }]);
  const top = (await client.stackTraceRequest({ threadId })).body.stackFrames[0];
  const scopes = await client.scopesRequest({ frameId: top.id });
  assert.deepStrictEqual(scopes.body.scopes.map((scope) => scope.name), ["Variables", "Sensors"]);
  const variables = await client.variablesRequest({ variablesReference: scopes.body.scopes[0].variablesReference });
  assert.strictEqual(variables.body.variables.find((one) => one.name === "n").value, "2");
  const value = await client.evaluateRequest({ expression: "n * 10", context: "hover" });
  assert.strictEqual(value.body.result, "20");
  const source = await client.sourceRequest({ sourceReference: top.source.sourceReference });
  assert.ok(source.body.content.includes("print(n)"));

  const info = await client.customRequest("dataBreakpointInfo", { variablesReference: 1, name: "n" });
  assert.strictEqual(info.body.dataId, "n");
  const watched = await client.customRequest("setDataBreakpoints", {
    breakpoints: [{ dataId: "n", accessType: "write" }, { dataId: "nobody" }],
  });
  assert.deepStrictEqual(watched.body.breakpoints.map((one) => one.verified), [true, false]);
  await client.customRequest("setDataBreakpoints", { breakpoints: [] });

  // The present: there variables can be set.
  await client.customRequest("continue", { threadId });
  const changed = await client.setVariableRequest({ variablesReference: 1, name: "n", value: "7" });
  assert.strictEqual(changed.body.value, "7");
  await assert.rejects(client.customRequest("fly"), /does not know 'fly'/);
  await moves(() => client.restartRequest({}), 1);
  const ended = client.waitForEvent("terminated");
  await client.setBreakpointsRequest({ source: { path: program }, breakpoints: [] });
  await client.continueRequest({ threadId });
  await ended;
  await client.disconnectRequest();
}

// A program of data flow, by the file that holds its text: a breakpoint by a label, the token that comes, a step back.
async function flow(trik) {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), "trik-dap-"));
  const file = path.join(folder, "count.flow");
  fs.writeFileSync(file, `diagram "Counter"
  numbers: Loop(start_border = 1, end_border = 9, increment = 1, time = 100)
  sum: "Text programming"(IO0 = \`sum = 2 * I0; sum\`)
  wheels: Motors
  numbers.OUT -> sum.I0
  sum.O0 -> wheels.M3
`);
  const client = new DebugClient(trik, "dap", "trik");
  await client.start();
  const { launched } = await begun(client, { program: file });
  const names = [{ name: "wheels", condition: "data > 6" }, { name: "whels" }];
  const set = await client.setFunctionBreakpointsRequest({ breakpoints: names });
  assert.deepStrictEqual(set.body.breakpoints.map((one) => one.verified), [true, false]);
  assert.match(set.body.breakpoints[1].message, /did you mean 'wheels'/);
  let stopped = soon(client, "stopped");
  await client.configurationDoneRequest();
  await launched;
  const { threadId, reason, text } = (await stopped).body;
  assert.deepStrictEqual([reason, text], ["breakpoint", "wheels.M3 gets 8"]);
  const value = await client.evaluateRequest({ expression: "sum", context: "hover" });
  assert.strictEqual(value.body.result, "8");
  stopped = soon(client, "stopped");
  await client.stepBackRequest({ threadId });
  assert.strictEqual((await stopped).body.text, "sum.I0 gets 4");
  const ended = soon(client, "terminated");
  await client.terminateRequest();
  await ended;
  await client.disconnectRequest();
  fs.rmSync(folder, { recursive: true });
  console.log("the debugger: a program of data flow");
}

// Some time for the processes on both sides.
const PATIENCE = 60_000;

const soon = (client, event) => client.waitForEvent(event, PATIENCE);

async function begun(client, args) {
  client.defaultTimeout = PATIENCE;
  await client.initializeRequest();
  const initialized = soon(client, "initialized");
  const launched = client.launchRequest(args);
  // It is answered after configurationDone.
  launched.catch(() => undefined);
  await initialized;
  // Not the promise alone: to return it would be to wait for it.
  return { launched };
}

// Breakpoints, threads, stack, variables, a step, an error, an end: all pass through to debugpy.
async function python(client, robot) {
  const file = path.join(robot.folder, "turn.py");
  fs.writeFileSync(file, "def double(k):\n    return k * 2\nn = double(21)\nprint('n is', n)\nprint(n / 0)\n");
  const { launched } = await begun(client, { program: file, robot: robot.tree, python: process.env.TRIK_DEBUGPY_PYTHON });
  const set = await client.setBreakpointsRequest({ source: { path: file }, breakpoints: [{ line: 2 }] });
  assert.strictEqual(set.body.breakpoints[0].verified, true);
  await client.setExceptionBreakpointsRequest({ filters: ["uncaught"] });
  let stopped = soon(client, "stopped");
  await client.configurationDoneRequest();
  await launched;
  const { threadId } = (await stopped).body;
  const threads = await client.threadsRequest();
  assert.deepStrictEqual(threads.body.threads, [{ id: threadId, name: "MainThread" }]);
  const stack = await client.stackTraceRequest({ threadId });
  assert.deepStrictEqual(stack.body.stackFrames.slice(0, 2).map((frame) => frame.line), [2, 3]);
  const frameId = stack.body.stackFrames[0].id;
  const scopes = await client.scopesRequest({ frameId });
  const variables = await client.variablesRequest({ variablesReference: scopes.body.scopes[0].variablesReference });
  assert.strictEqual(variables.body.variables.find((one) => one.name === "k").value, "21");
  const value = await client.evaluateRequest({ expression: "k + 1", frameId, context: "watch" });
  assert.strictEqual(value.body.result, "22");
  stopped = soon(client, "stopped");
  await client.stepOutRequest({ threadId });
  assert.strictEqual((await stopped).body.reason, "step");
  await assert.rejects(client.customRequest("stepBack", { threadId }), /cannot be taken back/);
  stopped = soon(client, "stopped");
  await client.continueRequest({ threadId });
  assert.strictEqual((await stopped).body.reason, "exception");
  const ended = soon(client, "terminated");
  await client.continueRequest({ threadId });
  await ended;
  await client.disconnectRequest();
}

// What the engine of JavaScript can, and words for what it cannot.
async function javascript(client, robot) {
  const file = path.join(robot.folder, "turn.js");
  fs.writeFileSync(file, "function turn() {\n  script.wait(20);\n}\nfor (let i = 0; i < 1000000; ++i) turn();\n");
  const { launched } = await begun(client, { program: file, robot: robot.tree, stopOnEntry: true });
  await launched;
  const set = await client.setBreakpointsRequest({ source: { path: file }, breakpoints: [{ line: 2 }] });
  assert.strictEqual(set.body.breakpoints[0].verified, false);
  let stopped = soon(client, "stopped");
  await client.configurationDoneRequest();
  const { threadId, reason } = (await stopped).body;
  assert.strictEqual(reason, "entry");
  await assert.rejects(client.nextRequest({ threadId }), /can only be paused/);
  await assert.rejects(client.evaluateRequest({ expression: "i" }), /can only be paused/);
  await client.continueRequest({ threadId });
  stopped = soon(client, "stopped");
  await client.pauseRequest({ threadId });
  assert.strictEqual((await stopped).body.reason, "pause");
  const threads = await client.threadsRequest();
  assert.deepStrictEqual(threads.body.threads, [{ id: threadId, name: "main" }]);
  await client.stackTraceRequest({ threadId });
  const ended = soon(client, "terminated");
  await client.terminateRequest();
  await ended;
  await client.disconnectRequest();
}

// A virtual robot whose programs run in the environment that has debugpy.
async function virtual(trik) {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), "trik-dap-"));
  const tree = path.join(folder, "robot");
  const bin = path.dirname(process.env.TRIK_DEBUGPY_PYTHON);
  const lua = path.resolve(process.env.TRIK_LUA || path.join(path.dirname(trik), "..", "..", "config", "lua"));
  const env = { ...process.env, XDG_RUNTIME_DIR: folder, PATH: `${bin}:${process.env.PATH}` };
  process.env.XDG_RUNTIME_DIR = folder;
  const words = ["up", "--no-view", "--no-page", "--trikd-ports", "0", "--include", lua, tree];
  const up = spawn(trik, words, { env, stdio: ["ignore", "pipe", "ignore"] });
  await new Promise((done, failed) => {
    up.stdout.once("data", done);
    up.once("exit", () => failed(new Error("there is no virtual robot")));
  });
  const end = async () => {
    const gone = new Promise((done) => up.once("exit", done));
    up.kill();
    await gone;
    fs.rmSync(folder, { recursive: true, force: true });
  };
  return { folder, tree, end };
}

async function texts(trik) {
  if (!process.env.TRIK_DEBUGPY_PYTHON) {
    console.log("skipped: programs in Python and JavaScript: TRIK_DEBUGPY_PYTHON is not set");
    return;
  }
  const robot = await virtual(trik);
  try {
    for (const talk of [python, javascript]) {
      const client = new DebugClient(trik, "dap", "trik");
      await client.start();
      await talk(client, robot);
    }
  } finally {
    await robot.end();
  }
  console.log("the debugger: programs in Python and JavaScript on a virtual robot");
}

async function main() {
  const trik = process.argv[2];
  const streams = new DebugClient(trik, "dap", "trik");
  await streams.start();
  await talk(streams);

  const server = spawn(trik, ["dap", "--listen", "0"], { stdio: ["ignore", "ignore", "pipe"] });
  const port = await new Promise((done) => {
    let said = "";
    server.stderr.on("data", (text) => {
      said += text;
      const found = said.match(/waiting on .*:(\d+)\n/);
      if (found) done(Number(found[1]));
    });
  });
  const wire = new DebugClient(trik, "dap", "trik");
  await wire.start(port);
  await talk(wire);
  server.kill();
  console.log("the debugger: every request over standard streams and TCP");
  await flow(trik);
  await texts(trik);
}

main().then(
  () => process.exit(0),
  (error) => {
    console.error(error);
    process.exit(1);
  },
);
