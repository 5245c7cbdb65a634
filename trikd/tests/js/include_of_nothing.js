include("nothing.js");
//! Line 1: Error: include: FOLDER/nothing.js: cannot be opened: No such file or directory (os error 2)
//! <global>() at 1
