var calls = {
    i2c: function() { brick.i2c(1, 0x40); },
    bus: function() { brick.smBusI2c(1, 0x99); },
    image: function() { brick.irCamera().getImage(); },
    signal: function() { brick.irCamera().imageUpdated.connect(print); },
};
for (var name in calls) {
    try { calls[name](); print(name, " did nothing"); } catch (e) { print(e.name, " ", e.message.split(":")[0]); }
}
print(brick.eventDevice("/dev/input/event0"), " ", brick.soundSensor(video2));
//> RangeError there is no bus 1
//> RangeError address 153 is not 3 to 119 (0x77)
//> TypeError irCamera.getImage
//> TypeError irCamera.imageUpdated
//> null null
