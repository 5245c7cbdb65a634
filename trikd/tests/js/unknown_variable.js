print("before");
print(foo);
//> before
//! Line 2: ReferenceError: Can't find variable: foo
//! <global>() at 2
