//! Integrators: their coefficients, orders and steps, their events, and their errors.

#[macro_use]
#[path = "../mechanisms/mod.rs"]
#[allow(dead_code, reason = "the ball is for tests of contact")]
mod mechanisms;
#[macro_use]
#[path = "../methods/mod.rs"]
mod methods;
#[path = "../order_conditions/mod.rs"]
mod order_conditions;
#[path = "../problems/mod.rs"]
mod problems;

mod accuracy;
mod corrections;
mod events;
mod events_accuracy;
mod failures;
mod gauss;
mod ode15s;
mod ode15s_limits;
mod order_eight;
mod radau;
mod save_at;
mod semi_implicit_euler;
mod stability;
mod steps;
mod stiffness;
mod tableau;
