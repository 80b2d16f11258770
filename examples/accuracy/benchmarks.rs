//! Problems A01 and A02 of the IFToMM benchmark library in one table: the precision they ask for, our error and time.

use std::time::Instant;

use redysim::generic::{GenericMechanism, Model};
use redysim::{
    ClosedLoop, ClosedLoopSimulation, Dop853, ForwardSimulation, Gauss6, Integrator, LoopClosure, Ode4, Ode45,
    TreeDynamics, Vector, ZeroTorque, redysim,
};

use crate::common::csv::Csv;
use crate::common::outputs::workspace;
use crate::common::table::{Table, headline, remark, tiny};
use crate::common::{Context, Failure, Outputs};

redysim! {
    /// A point mass of 1 kg on a massless bar of 1 m.
    pub struct SimplePendulum("../../models/simple_pendulum.toml");
}

redysim! {
    /// Three cranks, two couplers.
    pub struct NFourbar2("../../models/n_fourbar_2.toml");
}

/// The precision that the library asks for at the end, m, with low and with high demands.
const ASKED: (f64, f64) = (1e-1, 1e-3);

/// The rows of the table.
struct Rows {
    table: Table,
    csv: Csv,
}

impl Rows {
    fn row(&mut self, name: &str, duration: f64, error: f64, seconds: f64) {
        let met = if error <= ASKED.1 { "both" } else { "low" };
        let cells = [name.to_owned(), format!("{duration:.0}"), tiny(error), met.to_owned(), format!("{seconds:.4}")];
        self.table.row(cells);
        self.csv.named_row(name, [duration, error, seconds]);
    }
}

/// Where a bar of 1 m ends whose angle from `down` is `angle`.
fn tip(angle: f64) -> [f64; 2] {
    [angle.sin(), angle.cos()]
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// The pendulum let go from the horizontal on the side of +x, for 2,000 s as the library asks.
fn pendulum(rows: &mut Rows, name: &str, method: &impl Integrator<f64>) -> Result<(), Failure> {
    // By Jacobi's elliptic functions.
    const END: [f64; 2] = [-0.814_603_068_589_032_2, -0.580_018_827_836_935_5];
    let mut simulation = ForwardSimulation::new(&SimplePendulum, ZeroTorque);
    let start = simulation.state(&[std::f64::consts::FRAC_PI_2], &[0.0]);
    let begun = Instant::now();
    let end = method.integrate(&mut simulation, (0.0, 2000.0), start)?;
    let [x, y] = tip(end.y[0]);
    rows.row(&format!("A01, {name}"), 2000.0, distance([x, -y], END), begun.elapsed().as_secs_f64());
    Ok(())
}

/// Windows that start upright with their tips at 1 m/s, against elliptic functions.
fn windows<M>(
    rows: &mut Rows,
    name: &str,
    mechanism: &M,
    method: &impl Integrator<f64>,
    (duration, end): (f64, [f64; 2]),
) -> Result<(), Failure>
where
    M: TreeDynamics<f64> + LoopClosure<f64, M>,
{
    let mut simulation = ClosedLoopSimulation::new(ClosedLoop::new(mechanism), ZeroTorque);
    let q = M::Coordinates::from_fn(mechanism.nq(), |_| 0.0);
    let v = M::Velocities::from_fn(mechanism.nv(), |joint| if joint.is_multiple_of(2) { -1.0 } else { 1.0 });
    let start = simulation.start(&q, &v)?;
    let begun = Instant::now();
    let state = method.integrate(&mut simulation, (0.0, duration), start)?.y;
    // Cranks turned towards +x have negative coordinates.
    let error = state.as_ref().first().map_or(f64::NAN, |&q| distance(tip(-q), end));
    rows.row(&format!("A02, {name}"), duration, error, begun.elapsed().as_secs_f64());
    Ok(())
}

/// Prints the table.
pub fn report(outputs: &mut Outputs) -> Result<(), Failure> {
    headline("IFToMM benchmark library: A01 (simple pendulum), A02 (N four-bar)");
    let headers = ["problem, method", "span [s]", "error [m]", "time [s]"].map(String::from);
    let table = Table::new(&["", "span\ns", "error at the end\nm", "keeps\n", "time\ns"]);
    let mut rows = Rows { table, csv: Csv::new(&headers) };
    pendulum(&mut rows, "Ode4, 10 ms", &Ode4::new(1e-2))?;
    pendulum(&mut rows, "Ode45, rtol 1e-8", &Ode45::new().rtol(1e-8).atol(1e-10))?;
    pendulum(&mut rows, "Dop853, rtol 1e-8", &Dop853::new().rtol(1e-8).atol(1e-10))?;
    pendulum(&mut rows, "Dop853, rtol 1e-12", &Dop853::new().rtol(1e-12).atol(1e-14))?;
    pendulum(&mut rows, "Gauss6, 20 ms", &Gauss6::new(2e-2))?;
    let two = (10.0, [0.328_458_111_540_815_4, 0.944_518_538_178_601]);
    windows(&mut rows, "N = 2, Ode4, 10 ms", &NFourbar2, &Ode4::new(1e-2), two)?;
    windows(&mut rows, "N = 2, Ode4, 1 ms", &NFourbar2, &Ode4::new(1e-3), two)?;
    windows(&mut rows, "N = 2, Ode45, rtol 1e-6", &NFourbar2, &Ode45::new().rtol(1e-6).atol(1e-8), two)?;
    let path = workspace().join("models/n_fourbar_40.toml");
    let forty = Model::load(&path).context(|| format!("cannot read {}", path.display()))?;
    let forty = GenericMechanism::new(forty.model);
    let end = (20.0, [0.410_901_153_762_945_2, 0.911_679_900_971_981_7]);
    windows(&mut rows, "N = 40, generic, Ode4, 10 ms", &forty, &Ode4::new(1e-2), end)?;
    rows.table.print();
    let (low, high) = ASKED;
    remark(&format!(
        "The library asks for {low} m (low precision) and {high} m (high). Published: OpenSim 0.64 s for A01"
    ));
    remark("and 0.46 s for A02 with N = 40 on another machine; Exudyn 0.04 s for 10 s of A01.");
    outputs.numbers("iftomm", "IFToMM A01 and A02: errors and times", &rows.csv)
}
