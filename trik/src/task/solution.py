# {GOOD}
from trik import brick, script

brick.motor("M3").setPower(60)
brick.motor("M4").setPower(60)
while brick.sensor("D1").read() > 20:
    script.wait(10)
brick.stop()
script.wait(200)
