brick.led().orange();
brick.led().red();
brick.say("hello");
brick.playSound("beep.wav");
brick.playTone(-1, 5);
brick.playTone(440, 5);
//= led/red/value 1
//= led/green/value 0
//= sound/say/value hello
//= sound/tone/value 440 5
