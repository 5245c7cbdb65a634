var timer = script.timer(5), count = 0, log = [];
var counter = { add: function() { this.sum = (this.sum || 0) + 1; } };
function first() {
    log.push("first");
    timer.timeout.disconnect(first);
}
function tick() {
    if (++count == 3) {
        timer.stop();
        print(log, " ", counter.sum, " ", timer.isActive());
        script.quit();
    }
}
timer.timeout.connect(first);
timer.timeout.connect(counter, counter.add);
timer.timeout.connect(counter, "add");
timer.timeout.connect(tick);
try { timer.timeout.connect(5); } catch (e) { print(e); }
try { timer.timeout.disconnect(main); } catch (e) { print(e.name); }
script.run();
print("after run");
//> TypeError: Function.prototype.connect: target is not a function
//> ReferenceError
//> after run
//> [first] 6 false
