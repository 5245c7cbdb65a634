async function work() {
    await null;
    nothing;
}
work();
//! Line 3: ReferenceError: Can't find variable: nothing
//! work() at 3
