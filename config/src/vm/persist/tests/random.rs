//! Random programs: what a copy does is what the program does that runs anew.
//!
//! Owns a generator of programs whose values hold each other: tables in circles, functions that share variables,
//! metatables, environments, globals. The converter goes through all of it in an order of its own, calls what it finds, and
//! changes it. A failure shows the seed and the program.

use super::{copied, source};
use needs::Random;
use proptest::prelude::*;
use std::fmt::Write as _;

/// Goes through a value and returns a number that tells what it holds. Keys are sorted: the order of `pairs` is promised by
/// nobody. `seen` numbers the objects, so that a copy where there was the same object is noticed.
const VISIT: &str = "
local function visit(value, seen, depth)
  local kind = type(value)
  if kind == 'nil' then return 1 end
  if kind == 'boolean' then return value and 2 or 3 end
  if kind == 'number' then return 4 + value % 1000003 end
  if kind == 'string' then return 5 + #value * 7 + (value:byte(1) or 0) + (value:byte(-1) or 0) end
  if seen[value] then return 6 + seen[value] * 13 end
  seen.count = seen.count + 1
  seen[value] = seen.count
  if depth > 12 or seen.count > 200 then return 7 end
  if kind == 'function' then
    local worked, first, second = pcall(value, 3)
    if not worked then return 8 end
    return 9 + (visit(first, seen, depth + 1) * 17 + visit(second, seen, depth + 1) * 19) % 1000003
  end
  local keys = {}
  for key in next, value do
    if type(key) == 'string' or type(key) == 'number' then keys[#keys + 1] = key end
  end
  table.sort(keys, function(a, b)
    if type(a) ~= type(b) then return type(a) == 'number' end
    return a < b
  end)
  local sum = 10 + #keys
  for _, key in ipairs(keys) do
    sum = (sum * 31 + visit(key, seen, depth + 1) + visit(rawget(value, key), seen, depth + 1) * 37) % 1000003
  end
  local meta = getmetatable(value)
  if meta ~= nil then
    sum = (sum + visit(meta, seen, depth + 1) * 41) % 1000003
    local worked, found = pcall(function() return value.missing end)
    sum = (sum + visit(worked, seen, depth + 1) + visit(found, seen, depth + 1) * 43) % 1000003
  end
  return sum
end
";

/// What a variable of the program holds.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Number,
    Text,
    Table,
    Function,
}

struct Writer {
    random: Random,
    text: String,
    kinds: Vec<Kind>,
}

impl Writer {
    /// The number of the variable that the next declaration makes.
    fn new_one(&mut self, kind: Kind) -> usize {
        self.kinds.push(kind);
        self.kinds.len()
    }

    fn any(&mut self) -> usize {
        1 + self.random.below(self.kinds.len())
    }

    /// One of this kind, or any if there is none.
    fn of(&mut self, kind: Kind) -> Option<usize> {
        let start = self.random.below(self.kinds.len());
        let all = self.kinds.iter().enumerate().cycle().skip(start);
        let found = all
            .take(self.kinds.len())
            .find(|(_, known)| **known == kind);
        found.map(|(index, _)| index + 1)
    }

    fn number(&mut self) -> String {
        let all = [
            "0", "-0", "1", "255", "0.5", "-7", "1e15", "2^31", "-2^40", "300",
        ];
        all[self.random.below(all.len())].to_owned()
    }

    fn declare(&mut self) {
        let (a, b) = (self.any(), self.any());
        let (number, times) = (self.number(), self.random.below(3000));
        let counter = self.of(Kind::Number).unwrap_or(1);
        let line = match self.random.below(9) {
            0 => format!("local v{} = {number}", self.new_one(Kind::Number)),
            1 => format!(
                "local v{} = ('ab\\0c'):rep({times})",
                self.new_one(Kind::Text)
            ),
            2 => format!(
                "local v{} = {{ v{a}, v{b}, x = v{a}, [{times}] = v{b}, [-1] = {number} }}",
                self.new_one(Kind::Table)
            ),
            3 => format!(
                "local v{} = function(d) v{counter} = v{counter} + d return v{a}, v{b} end",
                self.new_one(Kind::Function)
            ),
            4 => {
                let (first, second) = (self.new_one(Kind::Function), self.new_one(Kind::Function));
                format!(
                    "local v{first}, v{second} = (function() local c = {number} return function(d) c = c + d return c end, function() return c, v{a} end end)()"
                )
            }
            5 => {
                let me = self.new_one(Kind::Function);
                format!(
                    "local function v{me}(d) if d > 0 then return v{me}(d - 1) end return v{a}, v{b} end"
                )
            }
            6 => format!(
                "local v{} = setmetatable({{ v{a} }}, {{ __index = function(t, k) return v{b} end, __gc = function() v{counter} = -1 end, __call = function() return v{a} end }})",
                self.new_one(Kind::Table)
            ),
            7 => format!(
                "local v{} = function(...) local n = select('#', ...) return g{a}, n + (h or 0) end",
                self.new_one(Kind::Function)
            ),
            _ => format!(
                "local v{} = tostring(v{counter}) .. 'x'",
                self.new_one(Kind::Text)
            ),
        };
        let _ = writeln!(self.text, "{line}");
    }

    fn change(&mut self) {
        let (a, b) = (self.any(), self.any());
        let name = self.random.below(4);
        let table = self.of(Kind::Table);
        let function = self.of(Kind::Function);
        let line = match (self.random.below(6), table, function) {
            (0, Some(t), _) => format!("v{t}.k{name} = v{a}"),
            (1, Some(t), _) => format!("setmetatable(v{t}, {{ __index = v{t}, made = v{a} }})"),
            (2, Some(t), _) => format!("v{t}[{name}] = v{t}"),
            (3, _, Some(f)) => format!("pcall(v{f}, {name})"),
            (4, ..) => format!("_G['g' .. {a}] = v{b}"),
            (5, ..) => format!("h = {name}"),
            (..) => format!("g{a} = v{b}"),
        };
        let _ = writeln!(self.text, "{line}");
    }
}

/// A program, and a converter that reaches some of its variables.
fn program(seed: u32) -> (String, String) {
    let mut writer = Writer {
        random: Random::new(seed),
        text: format!("{VISIT}local v1 = 1\n"),
        kinds: vec![Kind::Number],
    };
    for _ in 0..8 + writer.random.below(24) {
        writer.declare();
        if writer.random.below(2) == 0 {
            writer.change();
        }
    }
    let mut roots = String::new();
    for _ in 0..1 + writer.random.below(6) {
        let root = writer.any();
        let _ = write!(roots, "v{root}, ");
    }
    let global = writer.any();
    let converter = format!(
        "function(n, a, m, b)
           local sum = visit({{ {roots}g{global}, h }}, {{ count = 0 }}, 0)
           for i = 0, 3 do ba.set(b, i, math.floor(sum / 256 ^ i) % 256) end
         end"
    );
    (writer.text, converter)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    #[test]
    fn a_copy_of_a_random_program_does_what_the_program_does(seed: u32) {
        let (before, converter) = program(seed);
        let made = copied(&before, &converter);
        // A program that fails tells nothing of what it holds.
        prop_assert!(made.iter().all(Result::is_ok), "seed {}: {made:?} {}", seed, source(&before, &converter));
    }
}
