function tried(name, called) {
    try { print(name, " ", called()); } catch (e) { print(name, " ", e.name, ": ", e.message); }
}
tried("none", function () { brick.motor(M1).setPower(); });
tried("one of four", function () { brick.display().drawLine(1, 2, 3); });
tried("more", function () { brick.motor(M1).setPower(5, true, 7); return brick.motor(M1).power(); });
tried("text", function () { return brick.keys().isPressed("103"); });
tried("nothing to say", function () { brick.say(null); brick.display().addLabel(undefined, "1", null); return "done"; });
tried("random", function () { return script.random("3", 3.9); });
tried("wait", function () { script.wait(Infinity); return "at once"; });
tried("a thread", function () { Threading.startThread("x"); });
//> none SyntaxError: too few arguments in call to setPower(): it takes 1
//> one of four SyntaxError: too few arguments in call to drawLine(): it takes 4
//> more 5
//> text true
//> nothing to say done
//> random 3
//> wait at once
//> a thread SyntaxError: too few arguments in call to startThread(): it takes 2
//= motors/M1/value 5
