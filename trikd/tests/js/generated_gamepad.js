var __interpretation_started_timestamp__;
var x;

var main = function()
{
	__interpretation_started_timestamp__ = Date.now();
	brick.gyroscope().calibrate(1);
	script.wait(5);
	brick.keys().reset();
	while (!(gamepad.isPadPressed(1))) {
		script.wait(10);
	}
	x = gamepad.padX(1);
	if (brick.sensor(A1).read() > 40 && !brick.keys().wasPressed(KeysEnum.Esc)) {
		brick.motor(M3).setPower(x * 2);
		brick.display().addLabel(x, 0, 0);
	}
	switch (x) {
		case 10: print("ten ", brick.gyroscope().read()[6]); break;
		default: print("other");
	}
	return;
}
//< keys/device
//> ten 0
//= motors/M3/value 20
