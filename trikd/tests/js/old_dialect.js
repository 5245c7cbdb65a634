print("{0} and {1}, {2}".format("a", 2));
var let_ = 1, yes = [1, 2, 3].map(function(x) { return x * 2; });
print(yes, typeof undeclaredThing);
undeclared = 5;
print(undeclared, this.undeclared, arguments_of(1, 2));
function arguments_of() { return arguments.length + arguments.callee.name; }
with ({ inner: 3 }) print(inner);
print(010, " ", JSON.stringify({ a: [1] }), parseInt("0x10"));
label: for (;;) { for (;;) break label; }
print(hoisted());
function hoisted() { return "hoisted"; }
//> a and 2, {2}
//> [2, 4, 6]undefined
//> 552arguments_of
//> 3
//> 8 {"a":[1]}16
//> hoisted
