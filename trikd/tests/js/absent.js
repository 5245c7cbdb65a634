var calls = {
    i2c: function() { brick.i2c(1, 0x40); },
    bus: function() { brick.smBusI2c(1, 0x40); },
    event: function() { brick.eventDevice("/dev/input/event0"); },
    sound: function() { brick.soundSensor(video2); },
    image: function() { brick.irCamera().getImage(); },
    signal: function() { brick.irCamera().imageUpdated.connect(print); },
};
for (var name in calls) {
    try { calls[name](); print(name, " did nothing"); } catch (e) { print(e.name, " ", e.message.split(":")[0]); }
}
//> TypeError brick.i2c
//> TypeError brick.smBusI2c
//> TypeError brick.eventDevice
//> TypeError brick.soundSensor
//> TypeError irCamera.getImage
//> TypeError irCamera.imageUpdated
