var bad = function() {
    nothing.here();
}
var main = function() {
    Threading.startThread("bad", bad);
    while (true) { script.wait(1000); }
}
//! Line 2: ReferenceError: Can't find variable: nothing
//! bad() at 2
