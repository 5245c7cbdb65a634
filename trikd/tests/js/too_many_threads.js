var forever = function() { while (true) script.wait(1000); }
var main = function() {
    try {
        for (var i = 0; i < 100; i++) Threading.startThread("t" + i, forever);
    } catch (e) {
        print(e.message);
        Threading.reset();
        for (var i = 0; i < 100; i++) Threading.joinThread("t" + i);
        print("all gone");
    }
}
//> Threading: a program has at most 16 threads at once: wait for the end of some with Threading.joinThread
//> all gone
