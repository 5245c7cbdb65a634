-- A controller with nothing plugged in: every port shows what its usual device would give.
local trik = include 'trik.lua'

trikfs = trik.robot {}
