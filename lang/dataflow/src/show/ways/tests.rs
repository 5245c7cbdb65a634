//! Ways between obstacles, without a picture.

use super::*;

fn block(x: f64, y: f64) -> Obstacle {
    Obstacle {
        low: (x, y),
        high: (x + 100.0, y + 100.0),
        words: 30.0,
    }
}

fn port(block: usize, at: Place) -> Stop {
    Stop {
        at,
        block: Some(block),
        is_port: true,
    }
}

#[test]
fn a_line_meets_what_it_runs_through_and_not_what_it_touches() {
    let area = [(0.0, 0.0), (10.0, 10.0)];
    for (from, to, does) in [
        ((-5.0, 5.0), (15.0, 5.0), true),
        ((5.0, 5.0), (6.0, 6.0), true),
        ((-5.0, 0.0), (15.0, 0.0), false),
        ((10.0, -5.0), (10.0, 15.0), false),
        ((-5.0, 5.0), (5.0, -5.0), false),
        ((-5.0, 6.0), (6.0, -5.0), true),
        ((-5.0, 5.0), (0.0, 5.0), false),
        ((20.0, 5.0), (30.0, 5.0), false),
    ] {
        assert_eq!(meets(from, to, area), does, "{from:?} {to:?}");
        assert_eq!(meets(to, from, area), does, "{to:?} {from:?}");
    }
    assert!(!meets((0.0, 0.0), (9.0, 9.0), [(5.0, 5.0), (4.0, 6.0)]));
}

#[test]
fn a_way_goes_around_what_is_between_and_leaves_by_the_side_of_its_port() {
    let blocks = vec![block(0.0, 0.0), block(200.0, 0.0), block(400.0, 0.0)];
    let ends = [port(0, (98.0, 50.0)), port(2, (402.0, 50.0))];
    let drawn = vec![ends[0].at, ends[1].at];
    let way = Ways::new(blocks.clone(), &mut Looks::default()).way(drawn.clone(), ends, None);
    let wanted = [
        (98.0, 50.0),
        (110.0, 50.0),
        (110.0, -10.0),
        (390.0, -10.0),
        (390.0, 50.0),
        (402.0, 50.0),
    ];
    assert_eq!(way, wanted);
    // Edges of one port share a line, those of another one have their own; and what is not in the way.
    let mut looks = Looks::default();
    let mut ways = Ways::new(blocks.clone(), &mut looks);
    for (from, beside) in [((0, 1), 10.0), ((0, 2), 14.0), ((0, 1), 10.0)] {
        let way = ways.way(drawn.clone(), ends, Some(from));
        assert_eq!(way[2], (100.0 + beside, -beside));
    }
    let mut free = Ways::new(vec![blocks[0], block(200.0, 300.0), blocks[2]], &mut looks);
    assert_eq!(free.way(drawn.clone(), ends, None), drawn);
    // Nothing may be looked at any more.
    let mut none = Looks::at_most(0);
    let mut tired = Ways::new(blocks, &mut none);
    assert_eq!(tired.way(drawn.clone(), ends, None), drawn);
}

#[test]
fn a_way_that_there_is_not_stays_as_it_was_drawn() {
    // The first block is walled in, by blocks that lie upon each other.
    let mut blocks = vec![block(0.0, 0.0), block(600.0, 0.0)];
    for (x, y) in [
        (-80.0, -90.0),
        (-80.0, 90.0),
        (10.0, -90.0),
        (10.0, 90.0),
        (105.0, -40.0),
        (105.0, 50.0),
        (-105.0, -40.0),
        (-105.0, 50.0),
    ] {
        blocks.push(block(x, y));
    }
    let ends = [port(0, (98.0, 50.0)), port(1, (602.0, 50.0))];
    let drawn = vec![ends[0].at, ends[1].at];
    let mut looks = Looks::default();
    let mut ways = Ways::new(blocks, &mut looks);
    assert_eq!(ways.way(drawn.clone(), ends, None), drawn);
}

#[test]
fn one_that_is_far_away_does_not_use_up_what_may_be_looked_at() {
    let blocks = vec![
        block(0.0, 0.0),
        block(200.0, 0.0),
        block(400.0, 0.0),
        block(190_000.0, 190_000.0),
    ];
    let mut looks = Looks::default();
    let mut ways = Ways::new(blocks, &mut looks);
    let far = [port(0, (2.0, 50.0)), port(3, (190_098.0, 190_050.0))];
    ways.way(vec![far[0].at, far[1].at], far, None);
    assert!(looks.left > ROUTE_LOOKS_MAX / 2, "{}", looks.left);
}
