var forever = function() { while (true) script.wait(5); }
var main = function() {
    Threading.startThread("t", forever);
    Threading.startThread("t", forever);
}
//! Line 4: Error: Threading: Attempt to create a thread with an already occupied id t
//! main() at 4
//! <global>() at 7
