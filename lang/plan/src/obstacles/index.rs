//! Which of many boxes may meet a box: a tree of boxes, made once, as large as what is in it however uneven that is.
//!
//! Owns the tree. Knows no obstacles.

/// From the lowest x and y to the highest.
pub type Bounds = [f64; 4];

/// Boxes of a leaf.
const LEAF: usize = 4;

/// A tree over numbered boxes.
#[derive(Clone, Debug, Default)]
pub struct Index {
    /// In preorder: the left child of a node is the next one.
    nodes: Vec<Node>,
    /// The numbers of the boxes, in the order of the leaves.
    order: Vec<u32>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    bounds: Bounds,
    /// The right child; for a leaf 0.
    right: u32,
    from: u32,
    to: u32,
}

impl Index {
    /// A tree over these boxes; their numbers are their places.
    pub fn new(boxes: &[Bounds]) -> Self {
        let mut index = Self {
            nodes: Vec::new(),
            order: (0..boxes.len()).map(|at| at as u32).collect(),
        };
        if !boxes.is_empty() {
            let mut order = std::mem::take(&mut index.order);
            index.grow(boxes, &mut order, 0);
            index.order = order;
        }
        index
    }

    /// The box around all.
    pub fn bounds(&self) -> Option<Bounds> {
        self.nodes.first().map(|node| node.bounds)
    }

    /// Halves, so that it is never deeper than the logarithm of the number of boxes.
    fn grow(&mut self, boxes: &[Bounds], order: &mut [u32], from: usize) {
        let mut bounds = [
            f64::INFINITY,
            f64::INFINITY,
            f64::NEG_INFINITY,
            f64::NEG_INFINITY,
        ];
        for &at in order.iter() {
            let one = boxes[at as usize];
            bounds[0] = bounds[0].min(one[0]);
            bounds[1] = bounds[1].min(one[1]);
            bounds[2] = bounds[2].max(one[2]);
            bounds[3] = bounds[3].max(one[3]);
        }
        let this = self.nodes.len();
        self.nodes.push(Node {
            bounds,
            right: 0,
            from: from as u32,
            to: (from + order.len()) as u32,
        });
        if order.len() <= LEAF {
            return;
        }
        let axis = usize::from(bounds[3] - bounds[1] > bounds[2] - bounds[0]);
        let middle = order.len() / 2;
        let centre = |at: u32| boxes[at as usize][axis] + boxes[at as usize][axis + 2];
        order.select_nth_unstable_by(middle, |&a, &b| {
            centre(a).total_cmp(&centre(b)).then(a.cmp(&b))
        });
        let (left, right) = order.split_at_mut(middle);
        self.grow(boxes, left, from);
        self.nodes[this].right = self.nodes.len() as u32;
        self.grow(boxes, right, from + middle);
    }

    /// Whether something holds for any box whose leaf meets this one.
    pub fn any(&self, bounds: Bounds, holds: &mut impl FnMut(u32) -> bool) -> bool {
        !self.nodes.is_empty() && self.any_below(0, bounds, holds)
    }

    fn any_below(&self, node: usize, bounds: Bounds, holds: &mut impl FnMut(u32) -> bool) -> bool {
        let Node {
            bounds: own,
            right,
            from,
            to,
        } = self.nodes[node];
        if own[0] > bounds[2] || own[2] < bounds[0] || own[1] > bounds[3] || own[3] < bounds[1] {
            return false;
        }
        if right == 0 {
            let numbers = &self.order[from as usize..to as usize];
            return numbers.iter().any(|&number| holds(number));
        }
        self.any_below(node + 1, bounds, holds) || self.any_below(right as usize, bounds, holds)
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::random::Random;
    use super::*;

    #[test]
    fn all_boxes_that_meet_a_box_are_asked() {
        let mut random = Random::new(1);
        let mut boxes = vec![[-50.0, -50.0, 50.0, 50.0]; 3];
        for _ in 0..2000 {
            let (x, y) = (random.between(-9.0, 9.0), random.between(-9.0, 9.0));
            boxes.push([x, y, x + random.unit(), y + random.unit() * 0.1]);
        }
        let index = Index::new(&boxes);
        let mut asked_all = 0;
        for _ in 0..200 {
            let (x, y) = (random.between(-9.0, 9.0), random.between(-9.0, 9.0));
            let asked = [x, y, x + 0.3, y + 0.3];
            let mut seen = Vec::new();
            assert!(!index.any(asked, &mut |number| {
                seen.push(number);
                false
            }));
            asked_all += seen.len();
            for (number, one) in boxes.iter().enumerate() {
                let apart = one[0] > asked[2]
                    || one[2] < asked[0]
                    || one[1] > asked[3]
                    || one[3] < asked[1];
                assert!(apart || seen.contains(&(number as u32)));
            }
        }
        assert!(asked_all < 200 * 100, "{asked_all}");
        assert!(!Index::new(&[]).any([0.0; 4], &mut |_| true));
    }
}
