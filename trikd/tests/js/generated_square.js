var __interpretation_started_timestamp__;
var i;
var turn;
var forward;

turn = function() {
	brick.motor(M4).setPower(60);
	brick.motor(M3).setPower(-60);
	script.wait(20);
	return;
}

forward = function(power) {
	brick.motor(M4).setPower(power);
	brick.motor(M3).setPower(power);
	script.wait(20);
	return;
}

var main = function()
{
	__interpretation_started_timestamp__ = Date.now();

	i = 0;
	brick.encoder(E3).reset();
	for (var __iter__1 = 0; __iter__1 < 4; __iter__1++) {
		forward(80);
		turn();
		i = i + 1;
	}
	brick.motor(M3).powerOff();
	brick.motor(M4).powerOff();
	print(i);

	return;
}
//> 4
//= motors/M3/value 0
//= motors/M4/value 0
//= encoders/E3/value 0
