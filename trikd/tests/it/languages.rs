//! What Python and Lua have of the robot.

use crate::programs::run;
use crate::rig::robot;
use harness::put;

/// NaN was full power: no number is less than it, nor is it less than any.
#[test]
fn what_is_no_number_moves_nothing_in_python() {
    let robot = robot(&[]);
    robot.home.file("tree/motors/M1/value", "7\n");
    let mut client = robot.client("control");
    let text = "motor = brick.motor(M1)\n\
                for wrong in (float('nan'), float('inf'), -float('inf'), 'nan', '1e999', 'fast', '', None, [5], 10**400):\n\
                \x20 for call in (motor.setPower, script.wait):\n\
                \x20   try:\n      call(wrong)\n      print('taken:', repr(wrong)[:20])\n\
                \x20   except ValueError as error:\n      last = str(error)[:40]\n\
                print(last, '|', open(__import__('os').environ['TRIK_TREE'] + '/motors/M1/value').read())\n\
                motor.setPower('-25')\nmotor.setPower(-12.9)\nscript.wait('1')\n";
    run(&mut client, "wrong.py", text);
    client.expect("print: wait: 1000000000000000000000000000000000 | 7\n");
    client.expect("print: \n");
    client.until("info: wrong.py has ended after");
    assert_eq!(robot.home.content("tree/motors/M1/value"), b"-12\n");
}

#[test]
fn python_has_what_the_controller_has() {
    let robot = robot(&[]);
    for (file, content) in [
        ("lidar/value", "7 8 9\n"),
        ("gyroscope/value", "1 2 3\n"),
        ("gyroscope/tilt", "4 5\n"),
        ("gyroscope/heading", "170000\n"),
        ("ir_camera/value", "1 2 3 4\n"),
        ("servos/S1/value", "0\n"),
        ("servos/S1/units", "deg\n"),
        ("sound/tone/value", ""),
        ("motors/left/value", "0\n"),
        ("text/device", "one\ntwo\n"),
    ] {
        put(&robot.home.path("tree"), file, content);
    }
    let mut client = robot.client("control");
    let text = "import TRIK, trik\nfrom TRIK import *\nprint(TRIK is trik, TRIK.brick is brick)\n\
        print(brick.lidar().read(), brick.irCamera().readSensor(2, 1), brick.motorPorts())\n\
        print(Events.Key, MouseEventCodes.LeftBtn, PadEventCodes.BtnA, PadEventCodes.Hat1Y, PadEventCodes.Break)\n\
        brick.configure('video2', 'lineSensor')\nbrick.playTone(5, 20000)\n\
        g = brick.gyroscope()\ng.calibrationFinished.connect(script.quit)\ng.calibrate(1)\nscript.run()\n\
        print(g.isCalibrated(), g.read()[6])\n\
        lines = brick.fifo('text')\nprint(lines.read(), lines.read())\n\
        ticks = []\ntimer = script.timer('5')\ntimer.setSingleShot(True)\n\
        other = script.timer(1)\nother.timeout.connect(lambda: ticks.append(1))\nother.stop()\n\
        timer.timeout.connect(script.quit)\nscript.run()\nprint(ticks, timer.isActive(), timer.interval())\n\
        print(mailbox.stopWaiting(), script.system('echo spoken'), script.reset())\n\
        print(brick.sensor('A9'))\n";
    run(&mut client, "all.py", text);
    for wanted in [
        "print: True True\n",
        "print: [7, 8, 9] 3 ['M1', 'S1']\n",
        "print: 1 272 304 19 10\n",
        "print: True 0\n",
        "print: one two\n",
        "print: [] False 5\n",
        "print: None 0 None\n",
        "info: brick.sensor(A9): nothing is plugged in there; plugged in are A1, D1",
        "print: None\n",
    ] {
        client.expect(wanted);
    }
    client.until("info: all.py has ended after");
    assert_eq!(robot.home.content("tree/sound/tone/value"), b"20 10000\n");
}

#[test]
fn lua_runs_on_the_luajit_of_the_robot() {
    if !needs::tool("luajit") {
        return;
    }
    let robot = robot(&[]);
    let mut client = robot.client("control");
    let text = "local file = io.open(os.getenv('TRIK_TREE') .. '/sensors/A1/value')\nprint(file:read('*n') + 1)";
    run(&mut client, "a.lua", text);
    client.expect("print: 28\n");
    client.until("info: a.lua has ended after");
}
