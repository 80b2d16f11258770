//! Models of serial chains.

use std::fmt::Write;

/// The model file of a chain of `count` links: revolute joints whose axes turn by ±90° from link to link, general
/// centres of mass and inertias. No two links have the same numbers, and all have the same zeros.
pub fn model(count: usize) -> String {
    let mut spread = Spread(0.0);
    let mut text = format!("name = \"chain{count}\"\ngravity = [0.0, 0.0, -9.81]\n");
    for index in 1..=count {
        let parent = if index == 1 { "base".to_owned() } else { format!("link{}", index - 1) };
        let twist = if index % 2 == 0 { 90 } else { -90 };
        let [x, y] = [spread.next(0.05, 0.15), spread.next(0.02, 0.08)];
        let [mass, xx, yy, zz] = [(0.8, 3.0), (4e-3, 6e-3), (4e-3, 6e-3), (4e-3, 6e-3)].map(|(a, b)| spread.next(a, b));
        let [xy, yz, xz] = [8e-4; 3].map(|bound| spread.next(-bound, bound));
        let com = [0.06; 3].map(|bound| spread.next(-bound, bound));
        write!(
            text,
            "\n[[link]]\nname = \"link{index}\"\nparent = \"{parent}\"\njoint = \"revolute\"\n\
             origin = {{ xyz = [{x:?}, {y:?}, 0.0], rpy = [\"{twist} deg\", 0.0, 0.0] }}\naxis = [0.0, 0.0, 1.0]\n\
             mass = {mass:?}\ncom = {com:?}\n\
             inertia = {{ xx = {xx:?}, yy = {yy:?}, zz = {zz:?}, xy = {xy:?}, yz = {yz:?}, xz = {xz:?} }}\n"
        )
        .expect("a string takes all that is written");
    }
    text
}

/// Numbers that fill an interval evenly: multiples of the golden ratio, without whole parts.
struct Spread(f64);

impl Spread {
    /// The next number from `from` to `to`, with as many digits as a drawing would give.
    fn next(&mut self, from: f64, to: f64) -> f64 {
        self.0 += 1.0;
        let number = from + (to - from) * (self.0 * 1.618_033_988_749_895).fract();
        (number * 1e6).round() / 1e6
    }
}
