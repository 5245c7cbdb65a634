print(gamepad.isPadPressed(1), gamepad.padX(1), " ", gamepad.padY(1), gamepad.isPadPressed(2), gamepad.padX(2), gamepad.padX(7));
print(gamepad.wheel(), " ", gamepad.buttonIsPressed(2), gamepad.buttonIsPressed(1), gamepad.isConnected());
print(gamepad.buttonWasPressed(3), gamepad.buttonWasPressed(4), brick.gamepad() === gamepad);
//> true10 -20false-101-101
//> 30 truefalsetrue
//> truefalsetrue
