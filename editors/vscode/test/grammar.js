// The grammar as an editor runs it: each text of `texts` in tokens with their scopes, compared with what is written
// beside it. `UPDATE=1 node test/grammar.js` writes that anew.
"use strict";

const fs = require("fs");
const path = require("path");
const textmate = require("vscode-textmate");
const oniguruma = require("vscode-oniguruma");

const here = path.join(__dirname, "texts");
const grammar = path.join(__dirname, "..", "syntaxes", "dcml.tmLanguage.json");

async function tokenizer() {
  const wasm = fs.readFileSync(require.resolve("vscode-oniguruma/release/onig.wasm"));
  await oniguruma.loadWASM(wasm);
  const registry = new textmate.Registry({
    onigLib: Promise.resolve({
      createOnigScanner: (patterns) => new oniguruma.OnigScanner(patterns),
      createOnigString: (text) => new oniguruma.OnigString(text),
    }),
    loadGrammar: async (scope) =>
      scope === "source.dcml" ? textmate.parseRawGrammar(fs.readFileSync(grammar, "utf8"), grammar) : null,
  });
  return registry.loadGrammar("source.dcml");
}

// Each token that is no white space: its text and its scopes without the first one, which all have.
function scopes(rules, text) {
  let stack = textmate.INITIAL;
  const out = [];
  text.split("\n").forEach((line, index) => {
    const result = rules.tokenizeLine(line, stack);
    stack = result.ruleStack;
    for (const token of result.tokens) {
      const word = line.slice(token.startIndex, token.endIndex);
      if (word.trim() !== "") {
        const names = token.scopes.slice(1).map((name) => name.replace(/\.dcml$/, ""));
        out.push(`${index + 1}:${token.startIndex + 1} ${JSON.stringify(word)} ${names.join(" ")}`.trimEnd());
      }
    }
  });
  return `${out.join("\n")}\n`;
}

// What must hold whatever is written beside the texts.
function certain(rules) {
  const expected = [
    ["BEGIN Bart", "Bart", "entity.name.type.model"],
    ["ACTION: a, b;", "b", "meta.section.action variable.parameter.action"],
    ["PARAM : L;", "L", "meta.section.param variable.other.param"],
    ["CONST: g = -9.81;", "9.81", "meta.section.const constant.numeric"],
    ["CONFIG: theta [rad] in S1;", "S1", "meta.section.config support.type.circle"],
    ["d(x) = 1;", "d", "meta.derivative keyword.operator.derivative"],
    ["x = atan2(y, pi);", "atan2", "support.function.math"],
    ["x = atan2(y, pi);", "pi", "constant.language"],
    ["/** d(x) */", " d(x) ", "comment.block.documentation"],
    ["x = 1; // END", " END", "comment.line.double-slash"],
    ["begin x", "begin", "variable.other"],
  ];
  for (const [line, word, wanted] of expected) {
    const found = scopes(rules, line).split("\n");
    const row = found.find((one) => one.includes(` ${JSON.stringify(word)} `)) || "";
    if (!row.endsWith(` ${JSON.stringify(word)} ${wanted}`)) {
      throw new Error(`${line}: ${word} must be ${wanted}; there is\n${found.join("\n")}`);
    }
  }
}

async function main() {
  const rules = await tokenizer();
  certain(rules);
  const texts = fs.readdirSync(here).filter((name) => name.endsWith(".dcml"));
  if (texts.length < 3) {
    throw new Error(`only ${texts.length} texts in ${here}`);
  }
  let bad = 0;
  for (const name of texts) {
    const file = path.join(here, name);
    const beside = `${file}.scopes`;
    const found = scopes(rules, fs.readFileSync(file, "utf8"));
    if (process.env.UPDATE) {
      fs.writeFileSync(beside, found);
      continue;
    }
    const wanted = fs.readFileSync(beside, "utf8").split("\n");
    found.split("\n").forEach((row, index) => {
      if (row !== wanted[index]) {
        bad += 1;
        console.error(`${name}: ${row}\n  but ${path.basename(beside)}:${index + 1} has ${wanted[index]}`);
      }
    });
    bad += found.split("\n").length === wanted.length ? 0 : 1;
  }
  if (bad > 0) {
    throw new Error(`${bad} tokens are not as they were; UPDATE=1 if they are better now`);
  }
  console.log(`grammar: ${texts.length} texts as they should be`);
}

main().catch((error) => {
  console.error(`grammar: ${error.message}`);
  process.exit(1);
});
