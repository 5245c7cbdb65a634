# {BAD}
from trik import brick, script

brick.motor("M3").setPower(40)
brick.motor("M4").setPower(60)
script.wait(15000)
brick.stop()
