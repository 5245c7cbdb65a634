-- The display: one picture after the other into the frame buffer.
--
-- Owns the size of a picture: 320 x 240 pixels of two bytes, RGB565 with the low byte first, row by row from the upper
-- left corner. What is drawn is the business of those who write.
local display = { top = true, ports = { display = {} } }

local WIDTH, HEIGHT, PIXEL_BYTES = 320, 240, 2

function display.make(_, entry)
  return {
    display = {
      about = 'the display, 320 x 240 pixels: one picture after the other, RGB565 with the low byte first, row by row',
      src = entry:path('path', '/dev/fb0'), input_tuple_size = WIDTH * HEIGHT * PIXEL_BYTES,
    },
  }
end

return display
