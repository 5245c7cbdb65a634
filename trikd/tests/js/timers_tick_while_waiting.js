var n = 0;
script.repeat(5, function() { n++; });
while (n < 3) script.wait(5);
print("ticked");
var once = script.timer(1);
once.singleShot = true;
var seen = 0;
once.timeout.connect(function() { seen++; });
script.wait(60);
print(seen, " ", once.active);
//> ticked
//> 1 false
