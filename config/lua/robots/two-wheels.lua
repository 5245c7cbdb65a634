-- The usual car: two driven wheels, sensors to the front, to the left and to the floor, a camera and a gripper.
local trik = include 'trik.lua'

trikfs = trik.robot {
  { port = 'M3', type = 'motor100', name = 'left', encoder = 'E3' },
  { port = 'M4', type = 'motor100', name = 'right', encoder = 'E4' },
  { port = 'E3', type = 'encoder95', name = 'left' },
  { port = 'E4', type = 'encoder95', name = 'right' },
  { port = 'A1', type = 'sharpGP2', name = 'front_infrared' },
  { port = 'A3', type = 'touch', name = 'bumper' },
  { port = 'A5', type = 'light', name = 'floor_left' },
  { port = 'A6', type = 'light', name = 'floor_right' },
  { port = 'D1', type = 'ultrasonic', name = 'front' },
  { port = 'D2', type = 'ultrasonic', name = 'left' },
  { port = 'S1', type = 'angularServomotor', name = 'arm' },
  { port = 'S6', type = 'manipulatorServomotor', name = 'gripper' },
  { port = 'lidar' },
  { port = 'odometry', left = 'E3', right = 'E4', wheel_diameter_mm = 56, track_mm = 155 },
}
