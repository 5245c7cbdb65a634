// Starts `trik dcml lsp` for DCML documents and lets the client library of VS Code speak with it, and `trik dap` for
// diagrams that are debugged.
//
// Owns which program is started. What is known of models and diagrams is in that program; the colours are in the grammar.
"use strict";

const { commands, debug, DebugAdapterExecutable, window, workspace } = require("vscode");
const { LanguageClient, TransportKind } = require("vscode-languageclient/node");

let client;

function trik() {
  return workspace.getConfiguration("dcml").get("trikPath") || "trik";
}

async function start() {
  const program = trik();
  const server = { command: program, args: ["dcml", "lsp"], transport: TransportKind.stdio };
  client = new LanguageClient("dcml", "DCML", server, {
    documentSelector: [
      { language: "dcml", scheme: "file" },
      { language: "dcml", scheme: "untitled" },
    ],
  });
  try {
    await client.start();
  } catch (error) {
    client = undefined;
    window.showErrorMessage(
      `DCML: '${program} dcml lsp' could not be started (${error.message}). ` +
        "Install trik, or say in the setting dcml.trikPath where it is.",
    );
  }
}

async function stop() {
  const old = client;
  client = undefined;
  if (old) {
    // A server that has ended already has nothing left to be told.
    await old.stop().catch(() => undefined);
  }
}

// One after another: a setting may change while the server is still starting.
let turn = Promise.resolve();
function restart() {
  turn = turn.then(stop).then(start);
  return turn;
}

// A folder that is not trusted may not say which program is started.
function adapter() {
  if (!workspace.isTrusted) {
    throw new Error("this folder is not trusted, so no program is started for it");
  }
  return new DebugAdapterExecutable(trik(), ["dap"]);
}

exports.activate = async (context) => {
  context.subscriptions.push(
    debug.registerDebugAdapterDescriptorFactory("trik", { createDebugAdapterDescriptor: adapter }),
    commands.registerCommand("dcml.restart", restart),
    workspace.onDidChangeConfiguration((change) => {
      if (change.affectsConfiguration("dcml.trikPath")) {
        restart();
      }
    }),
  );
  if (workspace.isTrusted) {
    await restart();
  } else {
    context.subscriptions.push(workspace.onDidGrantWorkspaceTrust(restart));
  }
};

exports.deactivate = () => turn.then(stop);
