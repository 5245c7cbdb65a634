var a = 1;
var b = = 2;
//! Line 2: SyntaxError: Parse error: unexpected token in expression: '='
//! <global>() at 2
