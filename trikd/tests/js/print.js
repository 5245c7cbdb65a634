print("a", 1, true, null, undefined);
print(12, [1, 2, [3]]);
print([]);
print();
print({}, function f(x) { return x; });
print([null, undefined, "x"], 1e21, 0.1 + 0.2, -0, NaN);
print("\u041f\u0440\u0438\u0432\u0435\u0442, ", "\u0440\u043e\u0431\u043e\u0442");
print("half \ud800 of a character");
//> a1truenullundefined
//> 12[1, 2, [3]]
//> []
//>
//> [object Object]function f(x) { return x; }
//> [null, undefined, x]1e+210.300000000000000040NaN
//> Привет, робот
//> half � of a character
