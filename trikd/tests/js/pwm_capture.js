var pwm = brick.pwmCapture("S3");
print(pwm.frequency(), " ", pwm.duty(), " ", brick.pwmCapturePorts(), " ", brick.pwmCapture("S1"));
try { pwm.dutyRaw(); } catch (e) { print(e.name); }
//> [50, 50, 51] 7 [S3] null
//> TypeError
