var motor = brick.motor(M1), servo = brick.motor(S1);
[NaN, Infinity, -Infinity, "fast", undefined, {}, "1e999"].forEach(function (wrong) {
    motor.setPower(30);
    servo.setPower(40);
    motor.setPower(wrong);
    servo.setPower(wrong);
    if (brick.motor(M1).power() !== 0 || brick.motor(S1).power() !== 40)
        print(String(wrong), " moved ", motor.power(), " ", servo.power());
});
motor.setPower("-25");
servo.setPower([50]);
brick.motor(M3).setPower(-12.9);
brick.motor(M4).setPower(-3e9);
brick.playTone(NaN, NaN);
brick.playTone(1e9, "1e9");
print("done");
//> done
//! info: motor.setPower: NaN is no number: a motor stands still, a servo stays where it is
//= motors/M1/value -25
//= servos/S1/value 50
//= motors/M3/value -12
//= motors/M4/value -100
//= sound/tone/value 7000 10000
