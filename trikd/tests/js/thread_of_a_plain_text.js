var work = function() { Threading.sendMessage("main", "by name"); }
var main = function() {
    Threading.startThread("a", "work");
    Threading.joinThread("a");
    Threading.joinThread("nobody");
    print(Threading.receiveMessage());
    try { Threading.joinThread("main"); } catch (e) { print(e.message); }
}
//> by name
//> Threading: a thread cannot wait for its own end
