//! The same for eight states in a call.

mod robot;
mod speed;

fn main() {
    speed::print::<redysim::lanes::F64x8>();
}
