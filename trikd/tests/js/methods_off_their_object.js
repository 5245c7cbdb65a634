var power = brick.motor(M1).setPower, read = brick.sensor(A1).read, wait = script.wait, motor = brick.motor;
power(10);
wait(1);
print(read(), " ", motor(M1).power());
var timer = script.timer(5), connect = timer.timeout.connect, stop = timer.stop;
connect(function () { print("tick"); stop(); script.quit(); });
var led = brick.led(), rate = brick.gyroscope().read, draw = brick.display().drawPoint, find = mailbox.hasMessages;
led.red.call(null);
draw(1, 1);
print(rate().length, find(), brick.keys().isPressed.call({}, KeysEnum.Up));
var words = [];
for (var name in brick.motor(M1)) words.push(name);
print(words.indexOf("setPower") >= 0);
script.run();
//> 42 10
//> 7falsetrue
//> true
//> tick
//= motors/M1/value 10
//= led/red/value 1
