var all = [];
while (true) all.push(new Array(1000).join("x") + all.length);
//! Line 2: InternalError: out of memory: a thread of a program has 64 MiB
//! <global>() at 2
