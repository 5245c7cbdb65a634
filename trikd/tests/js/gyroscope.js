var g = brick.gyroscope();
var v = g.read();
print(v[0], " ", v.length, " ", v[4], " ", v[5], " ", v[6]);
g.calibrationFinished.connect(function() {
    print(g.read()[6], " ", g.isCalibrated());
    script.quit();
});
g.calibrate(5);
print(g.isCalibrated());
script.run();
//> 10 7 1 2 170000
//> false
//> 0 true
