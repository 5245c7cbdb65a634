script.timer(1).timeout.connect(function() { print("never"); });
print("end");
//> end
