var timer = script.timer(5);
timer.timeout.connect(function() { timer.stop(); mailbox.stopWaiting(); });
print("[", mailbox.receive(), "]");
//> []
