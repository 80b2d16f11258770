//! A robot on a free base: KR5 on a platform that floats.

use redysim::{ForwardSimulation, IntegrationError, Integrator, ZeroTorque};

use super::problem::{Problem, Quantity, Run, timed};
use crate::scenes::floating::{DURATION, FloatingArm, START, State, after, apart, arm, drifts};

/// The arm's free motion without gravity, judged by where its links are at the end, and by what is conserved.
pub struct Floating {
    arm: FloatingArm,
    end: State,
}

impl Floating {
    /// With its end in double-double.
    pub fn new() -> Self {
        Floating { arm: arm(), end: after(DURATION, &START) }
    }
}

impl Problem for Floating {
    fn name(&self) -> &'static str {
        "kr5_floating"
    }
    fn title(&self) -> &'static str {
        "KR5 afloat, 4 s"
    }
    fn quantities(&self) -> &'static [Quantity] {
        &[
            Quantity { name: "error", what: "error of the configuration at the end on the tangent, rad or m" },
            Quantity { name: "momentum", what: "change of the momentum, as a share of it" },
            Quantity { name: "energy", what: "change of the energy, as a share of it" },
        ]
    }
    fn duration(&self) -> f64 {
        DURATION
    }
    fn most_steps(&self) -> u64 {
        20_000
    }
    fn run(&self, method: &impl Integrator<f64>) -> Result<Run, IntegrationError<f64>> {
        let mut simulation = ForwardSimulation::new(&self.arm, ZeroTorque);
        let copy = simulation;
        let start = simulation.state(&START.0, &START.1);
        timed(
            || method.integrate(&mut simulation, (0.0, DURATION), start),
            |end| {
                let end = copy.split(end);
                let [momentum, energy] = drifts(&(end.q, end.v));
                vec![apart(&end.q, &self.end.0), momentum, energy]
            },
        )
    }
}
