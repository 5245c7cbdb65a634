function tick() {
    brick.motor("Z9").setPower(1);
}
script.timer(1).timeout.connect(tick);
script.run();
//! Line 2: TypeError: Result of expression 'brick.motor("Z9")' [null] is not an object.
//! tick() at 2
