script.timer(5).timeout.connect(function() { script.quit(); print("the function goes on"); });
while (true) script.wait(100000);
//> the function goes on
