// A talk with the server by the client library that VS Code itself uses for the wire, not by ours.
//
// usage: node test/server.js TRIK
"use strict";

const assert = require("assert");
const { spawn } = require("child_process");
const fs = require("fs");
const path = require("path");
const rpc = require("vscode-jsonrpc/node");

async function main() {
  const server = spawn(process.argv[2], ["dcml", "lsp"], { stdio: ["pipe", "pipe", "inherit"] });
  const ended = new Promise((done) => server.on("exit", done));
  const wire = rpc.createMessageConnection(
    new rpc.StreamMessageReader(server.stdout),
    new rpc.StreamMessageWriter(server.stdin),
  );
  const told = [];
  let heard = () => {};
  wire.onNotification("textDocument/publishDiagnostics", (news) => {
    told.push(news);
    heard();
  });
  // The news of a version; the test's caller ends what never comes.
  const diagnostics = async (version) => {
    for (;;) {
      const found = told.find((news) => news.version === version);
      if (found) return found.diagnostics;
      await new Promise((done) => {
        heard = done;
      });
    }
  };
  wire.listen();
  const begun = await wire.sendRequest("initialize", { processId: process.pid, rootUri: null, capabilities: {} });
  assert.strictEqual(begun.capabilities.positionEncoding, "utf-16");
  await wire.sendNotification("initialized", {});
  const uri = "file:///bart.dcml";
  const text = fs.readFileSync(path.join(__dirname, "texts", "bart.dcml"), "utf8");
  await wire.sendNotification("textDocument/didOpen", {
    textDocument: { uri, languageId: "dcml", version: 1, text },
  });
  assert.deepStrictEqual(await diagnostics(1), []);
  const line = text.split("\n").findIndex((one) => one.startsWith("d(phi_rear)"));
  const at = { textDocument: { uri }, position: { line, character: 3 } };
  const hover = await wire.sendRequest("textDocument/hover", at);
  assert.ok(hover.contents.value.includes("phi_rear"), JSON.stringify(hover));
  const places = await wire.sendRequest("textDocument/references", { ...at, context: { includeDeclaration: true } });
  assert.strictEqual(places.length, text.match(/\bphi_rear\b/g).length);
  const edit = await wire.sendRequest("textDocument/rename", { ...at, newName: "rear_angle" });
  assert.strictEqual(edit.changes[uri].length, places.length);
  const start = { line, character: 0 };
  await wire.sendNotification("textDocument/didChange", {
    textDocument: { uri, version: 2 },
    contentChanges: [{ range: { start, end: start }, text: "d(theta) = nosuch;\n" }],
  });
  assert.ok((await diagnostics(2)).some((one) => one.message.includes("nosuch")));
  await wire.sendRequest("shutdown");
  await wire.sendNotification("exit");
  assert.strictEqual(await ended, 0);
  console.log("server: talks with the client library of VS Code");
  wire.dispose();
}

main().catch((error) => {
  console.error(`server: ${error.stack}`);
  process.exit(1);
});
