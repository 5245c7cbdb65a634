script.writeToFile("notes.txt", "one\n");
script.writeToFile("notes.txt", "two");
script.writeData("notes.txt", [10, 0x33, 256 + 0x34]);
var lines = script.readAll("notes.txt");
print(lines.length, JSON.stringify(lines));
script.removeFile("notes.txt");
script.removeFile("notes.txt");
try { script.readAll("notes.txt"); } catch (e) { print(e.message.indexOf("notes.txt") >= 0); }
print(script.system("exit 3", true));
script.writeToFile("lib.js", "var fromLib = 5;\nfunction lib() {\n  return nothing;\n}\n");
include("lib.js");
print(fromLib);
lib();
//> 3["one\n","two\n","34"]
//> true
//> 3
//> 5
//! Line 3 of lib.js: ReferenceError: Can't find variable: nothing
//! lib() at lib.js:3
//! <global>() at 13
