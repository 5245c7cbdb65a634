function tick() {
    brick.motor("Z9").setPower(1);
}
script.timer(1).timeout.connect(tick);
script.run();
//! info: brick.motor(Z9): nothing is plugged in there; plugged in are M1, M3, M4, S1, S3
//! Line 2: TypeError: Result of expression 'brick.motor("Z9")' [null] is not an object.
//! tick() at 2
