var main = function() { print("once"); }
main();
//> once
