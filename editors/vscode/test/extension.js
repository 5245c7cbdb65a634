// The extension with stand-ins for the editor and the client library: which program is started, and when.
"use strict";

const assert = require("assert");
const Module = require("module");
const manifest = require("../package.json");

const seen = { adapters: {}, clients: [], errors: [], commands: {}, configured: [], trusted: [] };
const settings = { trikPath: "/opt/trik" };

class LanguageClient {
  constructor(id, name, server, options) {
    Object.assign(this, { id, name, server, options, running: false });
    seen.clients.push(this);
  }
  async start() {
    if (this.server.command === "/nowhere") {
      throw new Error("ENOENT");
    }
    this.running = true;
  }
  async stop() {
    this.running = false;
  }
}

class DebugAdapterExecutable {
  constructor(command, args) {
    Object.assign(this, { command, args });
  }
}

const vscode = {
  DebugAdapterExecutable,
  debug: {
    registerDebugAdapterDescriptorFactory: (type, factory) => {
      seen.adapters[type] = factory;
      return { dispose() {} };
    },
  },
  commands: {
    registerCommand: (name, does) => {
      seen.commands[name] = does;
      return { dispose() {} };
    },
  },
  window: { showErrorMessage: (text) => seen.errors.push(text) },
  workspace: {
    isTrusted: true,
    getConfiguration: (part) => ({ get: (key) => (part === "dcml" ? settings[key] : undefined) }),
    onDidChangeConfiguration: (does) => seen.configured.push(does),
    onDidGrantWorkspaceTrust: (does) => seen.trusted.push(does),
  },
};

const load = Module._load;
Module._load = (name, ...rest) => {
  if (name === "vscode") return vscode;
  if (name === "vscode-languageclient/node") return { LanguageClient, TransportKind: { stdio: 0 } };
  return load(name, ...rest);
};
const extension = require(`../${manifest.main}`);
Module._load = load;
// Node is happy to find the real one, which is what the package brings.
assert.ok(require.resolve("vscode-languageclient/node"));

async function main() {
  vscode.workspace.isTrusted = false;
  await extension.activate({ subscriptions: [] });
  assert.strictEqual(seen.clients.length, 0, "nothing is started in a folder that is not trusted");
  const debuggers = manifest.contributes.debuggers.map((one) => one.type);
  assert.deepStrictEqual(Object.keys(seen.adapters), debuggers);
  const adapter = () => seen.adapters.trik.createDebugAdapterDescriptor();
  assert.throws(adapter, /not trusted/);
  vscode.workspace.isTrusted = true;
  assert.deepStrictEqual([adapter().command, adapter().args], ["/opt/trik", ["dap"]]);
  await seen.trusted[0]();
  const first = seen.clients[0];
  assert.deepStrictEqual([first.server.command, first.server.args], ["/opt/trik", ["dcml", "lsp"]]);
  assert.ok(first.running);
  const languages = manifest.contributes.languages.map((one) => one.id);
  assert.ok(first.options.documentSelector.every((one) => languages.includes(one.language)));

  settings.trikPath = "/nowhere";
  seen.configured[0]({ affectsConfiguration: (name) => name === "dcml.trikPath" });
  await seen.commands["dcml.restart"]();
  assert.ok(!first.running);
  assert.ok(seen.errors[0].includes("/nowhere dcml lsp") && seen.errors[0].includes("dcml.trikPath"), seen.errors[0]);

  settings.trikPath = "";
  await seen.commands["dcml.restart"]();
  const last = seen.clients[seen.clients.length - 1];
  assert.ok(last.running && last.server.command === "trik", "an empty setting is the default");
  await extension.deactivate();
  assert.ok(!last.running);
  for (const command of manifest.contributes.commands) {
    assert.ok(seen.commands[command.command], `${command.command} does nothing`);
  }
  console.log("extension: starts, restarts and stops the server");
}

main().catch((error) => {
  console.error(`extension: ${error.stack}`);
  process.exit(1);
});
