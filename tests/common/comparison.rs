//! What "equal to so many digits" means, for every test.

use redysim::Real;

/// What is smaller than this part of the largest value of the run is held against that, not against itself.
const FLOOR: f64 = 1e-6;

/// Computed and expected values of one quantity, collected over a whole run.
///
/// The error of a component is |computed − expected| / max(|expected|, 1e-6 · the largest |expected| of the run), or
/// another part than 1e-6.
pub struct Comparison {
    what: String,
    floor: f64,
    samples: Vec<(Vec<f64>, Vec<f64>)>,
}

impl Comparison {
    pub fn new(what: impl Into<String>) -> Self {
        Comparison { what: what.into(), floor: FLOOR, samples: Vec::new() }
    }

    /// What is smaller than this part of the largest value is held against that part.
    pub fn with_floor(self, floor: f64) -> Self {
        Comparison { floor, ..self }
    }

    /// Adds one sample: the components of the quantity, computed and expected.
    pub fn add(&mut self, computed: &[f64], expected: &[f64]) {
        assert_eq!(computed.len(), expected.len(), "{}: number of components", self.what);
        self.samples.push((computed.to_vec(), expected.to_vec()));
    }

    /// The largest error of the run and where it is. NaN counts as infinite.
    pub fn worst(&self) -> (f64, String) {
        let expected = self.samples.iter().flat_map(|(_, expected)| expected);
        let floor = self.floor * expected.fold(0.0_f64, |largest, x| Real::maximum(largest, x.abs()));
        let mut worst = (0.0, String::from("nowhere"));
        for (sample, (computed, expected)) in self.samples.iter().enumerate() {
            for (component, (&x, &reference)) in computed.iter().zip(expected).enumerate() {
                let error = if x == reference { 0.0 } else { (x - reference).abs() / reference.abs().max(floor) };
                let error = if error.is_nan() { f64::INFINITY } else { error };
                if error > worst.0 {
                    worst = (error, format!("sample {sample}, component {component}: {x:e}, not {reference:e}"));
                }
            }
        }
        worst
    }

    /// Panics unless every component of every sample is right to `tolerance`.
    pub fn assert_within(&self, tolerance: f64) {
        assert!(!self.samples.is_empty(), "{}: nothing was compared", self.what);
        let (error, place) = self.worst();
        println!("{}: error {error:.1e}, allowed {tolerance:.0e}", self.what);
        assert!(error <= tolerance, "{}: error {error:.1e}, allowed {tolerance:.0e}; {place}", self.what);
    }
}
