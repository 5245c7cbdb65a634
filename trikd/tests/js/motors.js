brick.motor(M1).setPower(250);
brick.motor(M3).setPower(-12.6);
brick.motor(M4).brake(1);
brick.motor(S1).setPower(-400);
print(brick.motor(M1).power());
brick.motor(M1).setPeriod(20000);
brick.motor(S1).powerOff();
//> 100
//! info: motor.setPeriod: the tree sets the period of pulses by the type of the motor; nothing is changed
//= motors/M1/value 100
//= motors/M3/value -12
//= motors/M4/brake 1
//= motors/M4/value 0
//= servos/S1/value -90
//= servos/S1/power 0
