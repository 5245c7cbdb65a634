var __interpretation_started_timestamp__;
var shared = 5;

TASK_beeper = function() {
	Threading.sendMessage("main", "from beeper " + shared);
	return;
}
TASK_waiter = function() {
	while (true) {
		script.wait(10);
	}
}

var main = function()
{
	__interpretation_started_timestamp__ = Date.now();
	shared = 7;
	Threading.startThread("beeper", TASK_beeper);
	Threading.startThread("waiter", "TASK_waiter");
	print(Threading.receiveMessage());
	Threading.joinThread("beeper");
	Threading.killThread("waiter");
	Threading.joinThread("waiter");
	print("done");
	return;
}
//> from beeper 7
//> done
