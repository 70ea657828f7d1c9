//! A triangle that begins where the one before it ends, one or two clocks later.
//!
//! Long triangles let the next packets' words come in meanwhile, so that nothing comes between the
//! last tile of one and the first of the next: the depth that is compared is still on its way.

mod common;

use common::pair::Pair;
use common::random::Random;
use common::shapes::triangle;
use rtl_sim::UNITS;

#[test]
fn a_depth_that_is_still_on_its_way_to_memory_counts() {
    for units in UNITS {
        let mut pair = Pair::new(units);
        let mut random = Random::new(3);
        for round in 0..400 {
            let (x, y) = (random.within(500, 4900), random.within(1400, 3700));
            let near = random.within(1, 30_000);
            // It ends in a point, or in a row of several tiles, which lets the walker get ahead.
            let long = if round % 2 == 0 {
                [[x - 40, y - 1300, near], [x + 40, y - 1300, near], [x, y + 12, near]]
            } else {
                [[x - 400, y + 12, near], [x - 200, y - 1300, near], [x + 8, y + 12, near]]
            };
            // A few pixels around the long one's lower end, behind it.
            let (dx, dy) = (random.within(-24, 24), random.within(-8, 8));
            let (left, right, top) = (x + dx - 20, x + dx + 20, y + dy - 20);
            let far = near + random.within(0, 3);
            let short = [[left, top, far], [right, top, far], [x + dx, y + dy + 24, far]];
            for (vertices, colour) in [(long, round as u8), (short, !round as u8)] {
                pair.push(&triangle(vertices, colour, false).expect("on the screen").encode());
            }
        }
        pair.compare("after pairs of triangles");
    }
}
