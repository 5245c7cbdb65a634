-- What this robot has. After a change: trikfs check /etc/trikfs/robot.lua
-- and then: /etc/init.d/trikfs reload (on a PC: systemctl reload trikfs)
--
-- A beginning that every Linux can show; put the devices of your robot in its place.
-- Files that lie in this folder or in /usr/share/trikfs/lua can be taken in, for example:
--
--   include 'hello.lua'        needs a C compiler
--
-- How to describe a device: /usr/share/doc/trikfs on a PC, docs/user/config.md in the sources.

trikfs = {
  -- Seconds since the system was started.
  uptime = {
    src = '/proc/uptime',
    input_tuple_size = 32,
    format = 'f64 seconds',
    units = 's',
    converter = function(a_s, a, b_s, b)
      ba.f64(b, 0, tonumber(ba.text(a):match('%S+')))
    end,
  },

  -- A die: one number from 1 to 6 for each read.
  die = {
    src = '/dev/urandom',
    input_tuple_size = 4,
    format = 'u8 points',
    converter = function(a_s, a, b_s, b)
      ba.set(b, 0, ba.u32(a, 0) % 6 + 1)
    end,
  },
}
