script.removeFile("../display/device");
for (var i = 0; i < 3; i++) {
    brick.display().addLabel("text", 1, 1);
    brick.display().redraw();
}
brick.display().setPainterColor("reddish");
brick.display().showImage("none.png");
brick.display().show([1], 2, 2, "rgb32");
brick.display().show([1], 1, 1, "cmyk");
print("goes on");
//> goes on
//! info: display.redraw: the tree has no display (TREE/display/device); nothing is shown
//! info: display.setPainterColor: 'reddish' is no colour; there are white, black, red, darkred, green, darkgreen, blue, darkblue, cyan, darkcyan, magenta, darkmagenta, yellow, darkyellow, gray, darkgray, lightgray, orange, brown, pink, purple, all others of SVG and #rrggbb
//! info: display.showImage: FOLDER/none.png: No such file or directory (os error 2)
//! info: display.show: 2 x 2 pixels need 4 numbers, there are 1
