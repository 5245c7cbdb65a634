var line = brick.lineSensor("video1");
line.init(true);
print(line.read(), line.getDetectParameters());
line.detect();
line.stop();
print(brick.colorSensor(video1).read(2, 3), brick.colorSensor(video1).read(1, 1));
try { brick.colorSensor(video1).read(4, 1); } catch (e) { print(e); }
brick.configure("video1", "lineSensor");
brick.configure("A1", "light");
//> [5, 10, 20][1, 2, 3, 4, 5, 6]
//> [1, 2, 3][0, 0, 1]
//> RangeError: colorSensor has cells 1 to 3, not 4, 1
//! info: brick.configure of A1: the robot file says what is plugged in; nothing is changed
//= camera/line/detect 1
//= camera/line/hsv 1 2 3 4 5 6
//= camera/line/video_out 1
