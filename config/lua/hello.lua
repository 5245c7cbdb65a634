-- The first example: six nodes with every kind of converter.
--
--   trikfs mount --config hello.lua /tmp/trikfs
--   head -c 4 /tmp/trikfs/zero/device          prints 1234
--
-- Devices that are not there (a mouse, a keyboard) are no error: opening their files is.

trikfs = {
  -- A Lua function: sizes and byte arrays of input and output, positions from 0.
  random = {
    src = '/dev/urandom',
    input_tuple_size = 3,
    output_tuple_size = 3,
    converter = function(a_s, a, b_s, b)
      for i = 0, b_s - 1 do
        ba.set(b, i, ba.get(a, i) % 10 + (i + 1) + 33)
      end
    end,
  },

  -- A converter made by a function: it copies three bytes.
  random2 = {
    src = '/dev/urandom',
    input_tuple_size = 3,
    output_tuple_size = 3,
    converter = id_create(3),
  },

  -- C source, compiled on this machine.
  zero = {
    src = '/dev/zero',
    input_tuple_size = 4,
    output_tuple_size = 4,
    converter = {
      code = [[
        int converter(int in_s, char *in, int out_s, char *out)
        {
          for (int i = 0; i < out_s; i++)
            out[i] = (unsigned char)in[i] % 10 + '0' + i + 1;
          return 0;
        }
      ]],
    },
  },

  -- A shared library. This one ships with trikfs; its source is hello/hello.c.
  zero2 = {
    src = '/dev/zero',
    input_tuple_size = 4,
    output_tuple_size = 4,
    converter = 'libhello.so',
  },

  mouse = {
    src = '/dev/input/mouse0',
    input_tuple_size = 4,
    output_tuple_size = 4,
    converter = 'libhello.so',
  },

  keyboard = {
    src = '/dev/input/event2',
    input_tuple_size = 3,
    output_tuple_size = 3,
    converter = id_create(3),
  },
}
