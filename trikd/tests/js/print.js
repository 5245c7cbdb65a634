print("a", 1, true, null, undefined);
print(12, [1, 2, [3]]);
print([]);
print();
print({}, function f(x) { return x; });
print([null, undefined, "x"], 1e21, 0.1 + 0.2, -0, NaN);
print("Привет, ", "робот");
//> a1truenullundefined
//> 12[1, 2, [3]]
//> []
//>
//> [object Object]function f(x) { return x; }
//> [null, undefined, x]1e+210.300000000000000040NaN
//> Привет, робот
