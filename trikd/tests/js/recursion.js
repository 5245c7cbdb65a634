function f(n) { return f(n + 1) + 1; }
try { f(0); } catch (e) { print(e.name); }
f(0);
//> RangeError
//! Line 1: RangeError: Maximum call stack size exceeded.
//! f() at 1
//! f() at 1
//! f() at 1
//! f() at 1
//! f() at 1
//! f() at 1
//! f() at 1
//! f() at 1
//! f() at 1
//! f() at 1
