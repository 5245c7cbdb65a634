// Checks programs in F# with the compiler that the npm packages fable-standalone and fable-metadata have.
// usage: node fsharp.cjs FOLDER-OF-node_modules STUB.fs FILE.fs...
'use strict';
const fs = require('fs');
const path = require('path');
const vm = require('vm');

const [modules, stub, ...files] = process.argv.slice(2);
const bundle = fs.readFileSync(path.join(modules, 'fable-standalone/dist/bundle.min.js'), 'utf8');
const compiler = {};
vm.runInThisContext(`(function (exports, module) {${bundle}\n})`)(compiler, { exports: compiler });
const library = path.join(modules, 'fable-metadata/lib');
const names = fs.readdirSync(library).filter(name => !/^(Browser|Fable\.Repl)/.test(name)).map(name => name.replace(/\.dll$/, ''));
const read = name => new Uint8Array(fs.readFileSync(path.join(library, path.basename(name).replace(/\.dll$/, '') + '.dll')));
const manager = compiler.init();
const checker = manager.CreateChecker(names, read, []);
const sources = ['stub.fs', 'program.fs'];
for (const file of files) {
    const texts = [fs.readFileSync(stub, 'utf8'), fs.readFileSync(file, 'utf8')];
    const results = manager.ParseAndCheckProject(checker, 'program.fsproj', sources, texts, []);
    for (const error of manager.GetErrors(results))
        if (!error.IsWarning)
            console.error(`${path.basename(file)}:${error.FileName}:${error.StartLine}:${error.StartColumn}: ${error.Message}`);
}
