for (var i = 0; i < 3; i++) {
    brick.display().addLabel("text", 1, 1);
    brick.display().redraw();
}
brick.smile();
print("goes on");
//> goes on
//! info: display.addLabel: the display is not in the tree; nothing is shown
//! info: display.redraw: the display is not in the tree; nothing is shown
//! info: brick.smile: the display is not in the tree; nothing is shown
