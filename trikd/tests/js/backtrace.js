var depth = function(n) {
    if (n == 0) {
        var nothing = null;
        nothing.method();
    }
    depth(n - 1);
}
var main = function() {
    depth(2);
}
//! Line 4: TypeError: Result of expression 'nothing' [null] is not an object.
//! depth() at 4
//! depth() at 6
//! depth() at 6
//! main() at 9
//! <global>() at 12
