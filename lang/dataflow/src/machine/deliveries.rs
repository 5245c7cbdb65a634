//! Tokens on their way, in the order in which they were sent.
//!
//! Owns that a number is written where it stays and read where it lies: a processor stalls when it loads, as a whole, a value
//! whose parts were stored just before, and a value that is moved through a queue at once was such a load three times. The
//! benchmark `converter` shows it. Knows no limit: the machine has one.

use crate::limits::DELIVERIES_MIN;
use crate::program::Target;
use lang_expr::Value;

/// A ring of tokens.
#[derive(Debug, Default)]
pub(super) struct Deliveries {
    /// A power of two of them, or none.
    places: Vec<(Target, Value)>,
    /// Of the oldest token.
    first: usize,
    count: usize,
}

/// A place without a token.
const EMPTY: (Target, Value) = (Target { node: 0, port: 0 }, Value::Nil);

impl Deliveries {
    pub fn len(&self) -> usize {
        self.count
    }

    fn place(&self, at: usize) -> usize {
        // No place is asked for where there are none.
        self.first.wrapping_add(at) & self.places.len().wrapping_sub(1)
    }

    /// The token that comes next.
    pub fn front(&self) -> Option<&(Target, Value)> {
        match self.count {
            0 => None,
            _ => self.places.get(self.first),
        }
    }

    /// The same, to be changed.
    pub fn front_mut(&mut self) -> Option<&mut (Target, Value)> {
        match self.count {
            0 => None,
            _ => self.places.get_mut(self.first),
        }
    }

    /// Takes it.
    pub fn pop(&mut self) -> Option<(Target, Value)> {
        let (target, value) = self.next_place()?;
        Some((*target, std::mem::take(value)))
    }

    /// Takes the next token if it is a number.
    #[inline]
    pub fn pop_number(&mut self) -> Option<(Target, f64)> {
        let Some(&(target, Value::Float(number))) = self.front() else {
            return None;
        };
        self.next_place()?;
        Some((target, number))
    }

    /// The place of the oldest token, which is free from here on.
    fn next_place(&mut self) -> Option<&mut (Target, Value)> {
        self.front()?;
        let at = self.first;
        self.first = self.place(1);
        self.count -= 1;
        self.places.get_mut(at)
    }

    /// Adds a token.
    #[inline]
    pub fn push(&mut self, to: Target, token: &Value) {
        if self.count == self.places.len() {
            self.grow();
        }
        let at = self.place(self.count);
        let Some((target, value)) = self.places.get_mut(at) else {
            return;
        };
        *target = to;
        if let Value::Float(number) = token {
            *value = Value::Float(*number);
        } else {
            value.clone_from(token);
        }
        self.count += 1;
    }

    #[cold]
    fn grow(&mut self) {
        self.places.rotate_left(self.first);
        self.first = 0;
        let count = (2 * self.places.len()).max(DELIVERIES_MIN);
        self.places.resize(count, EMPTY);
    }

    /// All tokens, the oldest first.
    pub fn iter(&self) -> impl Iterator<Item = &(Target, Value)> {
        (0..self.count).filter_map(|at| self.places.get(self.place(at)))
    }

    /// Takes all away.
    pub fn clear(&mut self) {
        *self = Self::default();
    }
}

/// Only what is on its way, however large the ring was once.
impl Clone for Deliveries {
    fn clone(&self) -> Self {
        self.iter().cloned().collect()
    }
}

impl Extend<(Target, Value)> for Deliveries {
    fn extend<T: IntoIterator<Item = (Target, Value)>>(&mut self, tokens: T) {
        for (target, value) in tokens {
            self.push(target, &value);
        }
    }
}

impl FromIterator<(Target, Value)> for Deliveries {
    fn from_iter<T: IntoIterator<Item = (Target, Value)>>(tokens: T) -> Self {
        let mut all = Self::default();
        all.extend(tokens);
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::VecDeque;

    #[test]
    fn tokens_come_in_the_order_of_a_queue() {
        let mut random = needs::Random::new(7);
        let (mut ring, mut queue) = (Deliveries::default(), VecDeque::new());
        for number in 0..20_000_u32 {
            // Longer and shorter in turns, so that it grows amid its places.
            let grows = number / 500 % 2 == 0;
            if random.below(10) < if grows { 6 } else { 4 } {
                let to = Target {
                    node: number,
                    port: (number % 7) as u8,
                };
                let value = match number % 3 {
                    0 => Value::Float(f64::from(number)),
                    1 => Value::Int(number as i32),
                    _ => Value::text(number.to_string()),
                };
                ring.push(to, &value);
                queue.push_back((to, value));
            } else {
                let (next, number) = (queue.pop_front(), ring.pop_number());
                let number = number.map(|(to, number)| (to, Value::Float(number)));
                let taken = number.or_else(|| ring.pop());
                assert_eq!(format!("{taken:?}"), format!("{next:?}"));
            }
            assert_eq!(ring.len(), queue.len());
            let fronts = (ring.front(), queue.front());
            assert_eq!(format!("{:?}", fronts.0), format!("{:?}", fronts.1));
        }
        let copy = ring.clone();
        let texts = |tokens: Vec<&(Target, Value)>| format!("{tokens:?}");
        assert_eq!(texts(copy.iter().collect()), texts(queue.iter().collect()));
        assert!(copy.places.len() < 2 * copy.len().max(DELIVERIES_MIN));
        ring.clear();
        assert_eq!(
            (ring.len(), ring.front().is_none(), ring.pop().is_none()),
            (0, true, true)
        );
    }
}
