//! Tests of the functions of Lua that a converter may call, against the manual.

use super::*;

#[test]
fn string_functions_do_what_the_manual_says() {
    for (expression, value) in [
        ("('abc'):find('b', 1, true)", "2"),
        ("('a.c'):find('.', 1, true)", "2"),
        ("('abc'):find('b()')", "2"),
        ("select(3, ('abc'):find('(b)'))", "b"),
        ("('abc'):find('x')", "nil"),
        ("('abc'):find('', 10)", "nil"),
        ("('abc'):find('', -10)", "1"),
        ("('abc'):match('^(a)(b)')", "a"),
        ("('x = 12'):match('%d+')", "12"),
        ("('abc'):gsub('%w', '%0%0')", "aabbcc"),
        ("('abc'):gsub('%w', '%%%1')", "%a%b%c"),
        ("('hello world'):gsub('o', '0', 1)", "hell0 world"),
        ("select(2, ('hello world'):gsub('o', '0'))", "2"),
        ("('abc'):gsub('', '-')", "-a-b-c-"),
        ("('abc'):gsub('^a', 'x')", "xbc"),
        ("('aaa'):gsub('^a', 'x')", "xaa"),
        ("('$name is'):gsub('%$(%w+)', { name = 'x' })", "x is"),
        ("('abc'):gsub('b', function() return nil end)", "abc"),
        (
            "('abc'):gsub('(a)(b)', function(x, y) return y .. x end)",
            "bac",
        ),
        ("('abc'):gsub('%w', 1)", "111"),
        ("('abc def'):gsub('%w*', 'x')", "xx xx"),
        (
            "table.concat((function() local t = {} for k, v in ('a=1, b=2'):gmatch('(%w)=(%w)') do t[#t + 1] = k .. v end return t end)(), ';')",
            "a1;b2",
        ),
        (
            "table.concat((function() local t = {} for w in ('ab cd'):gmatch('%a*') do t[#t + 1] = '<' .. w .. '>' end return t end)())",
            "<ab><><cd><>",
        ),
        ("('ab'):rep(3)", "ababab"),
        ("('ab'):rep(3, '-')", "ab-ab-ab"),
        ("('ab'):rep(-1)", ""),
        (
            "string.format('%5.1f|%d|%s|%q', 1.25, 7, true, 'x')",
            "  1.2|7|true|\"x\"",
        ),
        ("('x'):upper() .. #'abc' .. ('abc'):byte(2)", "X398"),
    ] {
        assert_eq!(
            evaluated(&format!("(({expression}))")),
            value,
            "{expression}"
        );
    }
}

#[test]
fn string_functions_name_what_they_refuse() {
    assert_eq!(
        fault("('x'):find('[')"),
        "test.lua:1: malformed pattern (missing ']')"
    );
    assert_eq!(
        fault("('x'):gsub('(', '')"),
        "test.lua:1: unfinished capture"
    );
    assert_eq!(
        fault("('x'):gsub('x', '%2')"),
        "test.lua:1: invalid capture index"
    );
    assert_eq!(
        fault("for w in ('x'):gmatch('(') do end"),
        "test.lua:1: unfinished capture"
    );
    assert_eq!(
        fault("('x'):rep(1e9)"),
        "test.lua:1: a string of 1000000000 bytes is too long"
    );
    // Once: it takes a million steps.
    assert_eq!(
        evaluated("('a'):rep(1e5):find(('.-'):rep(20) .. 'b')"),
        "test.lua:1: pattern match takes too long"
    );
    assert_eq!(
        fault("string.find({}, 'x')"),
        "test.lua:1: bad argument #1 to 'find' (string expected, got table)"
    );
}

#[test]
fn table_functions_do_what_the_manual_says() {
    for (expression, value) in [
        (
            "(function() local t = {3, 1, 2, 5, 4} table.sort(t) return table.concat(t) end)()",
            "12345",
        ),
        (
            "(function() local t = {3, 1, 2} table.sort(t, function(a, b) return a > b end) return table.concat(t) end)()",
            "321",
        ),
        (
            "(function() local t = {'b', 'a'} table.sort(t) return table.concat(t) end)()",
            "ab",
        ),
        (
            "(function() local t = {} table.sort(t) return #t end)()",
            "0",
        ),
        (
            "(function() local t = {} for i = 1, 1000 do t[i] = (i * 7919) % 1009 end table.sort(t) for i = 2, 1000 do if t[i - 1] > t[i] then return i end end return 'sorted' end)()",
            "sorted",
        ),
        (
            "(function() local t = {1, 3} table.insert(t, 2, 2) table.insert(t, 4) return table.concat(t) end)()",
            "1234",
        ),
        (
            "(function() local t = {1, 2, 3} table.remove(t, 1) return table.concat(t) end)()",
            "23",
        ),
        ("math.floor(2.5) + bit.band(6, 3)", "4"),
        ("unpack({1, 2})", "1"),
        (
            "(function() local c = coroutine.wrap(function(x) local y = coroutine.yield(x + 1) return y * 2 end) c(1) return c(10) end)()",
            "20",
        ),
        (
            "select(2, xpcall(function() error('x', 0) end, function(m) return m .. 'y' end))",
            "xy",
        ),
    ] {
        assert_eq!(evaluated(&format!("({expression})")), value, "{expression}");
    }
    let error = "test.lua:1: bad argument #2 to 'insert' (position out of bounds)";
    assert_eq!(fault("table.insert({}, -2147483647, 1)"), error);
    assert_eq!(fault("table.insert({}, '-2147483647', 1)"), error);
}
