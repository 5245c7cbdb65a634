var seen = {};
for (var i = 0; i < 1000; i++) seen[script.random(3, 1)] = true;
print(Object.keys(seen));
print(Math.abs(script.time() - Date.now()) < 1000, script.timeInterval(5, 17), " ", script.timeInterval(2147483640, 8));
var before = script.time();
script.wait(20);
print(script.time() - before >= 19);
script.wait(-5);
script.wait("text");
//> [1, 2, 3]
//> true12 16
//> true
