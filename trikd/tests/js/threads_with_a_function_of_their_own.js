var start = function() {
    Threading.startThread("t", function() { Threading.sendMessage("main", "anonymous"); });
    print(Threading.receiveMessage());
}
if (typeof started === "undefined") {
    var started = true;
    start();
}
//> anonymous
