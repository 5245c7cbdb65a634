var busy = function() { while (true) { try { while (true); } catch (e) { print("caught"); } } }
var main = function() {
    Threading.startThread("busy", busy);
    script.wait(20);
    script.quit();
}
//>
