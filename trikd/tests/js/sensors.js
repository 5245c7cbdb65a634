print(brick.sensor(A1).read(), " ", brick.sensor("A1").readRawData());
print(brick.sensor(D1).read());
print(brick.sensor("Q1"), brick.encoder("E9"), brick.motor(""), brick.motor("../motors/M1"), brick.sensor(5));
print(brick.encoder(E1).read(), " ", brick.encoder(E1).readRawData());
print(brick.battery().readVoltage(), " ", brick.battery().readRawDataVoltage());
print(brick.accelerometer().read());
print(brick.sensorPorts(), brick.sensorPorts("analogSensor"), brick.encoderPorts());
print(brick.motorPorts("powerMotor"), brick.motorPorts("servoMotor"), brick.pwmCapturePorts());
print(brick.marker(), brick.lidar().read().length, brick.irCamera().readSensor(2, 3));
//< motors/left/value
//< sensors/D1/value
//< sensors/D1/raw -1 0
//> 42 172
//> -1
//> nullnullnullnullnull
//> 90 300
//> 7.4 500
//> [1, 2, 1000]
//> [A1, A2, D1][A1, A2][E1, E3]
//> [M1, M3, M4][S1, S3][S3]
//> null3606
//! info: brick.sensor(Q1): nothing is plugged in there; plugged in are A1, A2, D1
//! info: brick.encoder(E9): nothing is plugged in there; plugged in are E1, E3
//! info: brick.motor(): nothing is plugged in there; plugged in are M1, M3, M4, S1, S3
//! info: brick.motor(../motors/M1): nothing is plugged in there; plugged in are M1, M3, M4, S1, S3
//! info: brick.sensor(5): nothing is plugged in there; plugged in are A1, A2, D1
