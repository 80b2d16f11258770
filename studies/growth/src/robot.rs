//! One robot, built in every way.

use crate::generated;
use crate::package::{Built, Package, Profile};
use crate::sizes::{self, Sizes};
use redysim_codegen::passes::Passes;

/// Batches of calls in one run, of a millisecond or more.
const BATCHES: usize = 60;
/// A build that is quicker is done again, and the shorter time counts.
const QUICK: f64 = 5.0;
/// States in a call of the program with lanes.
const LANES: f64 = 8.0;

const ALL_FUNCTIONS: &str = include_str!("../program/main.rs");
const IN_LANES: &str = include_str!("../program/lanes.rs");
const SPEED: &str = include_str!("../program/speed.rs");
const MACRO: &str = "redysim::redysim! { pub struct Robot(\"model.toml\"); }";

/// What takes no robot at all, s and bytes.
pub struct Empty {
    pub dev: f64,
    pub release: f64,
    pub native: f64,
    pub text: u64,
}

/// What was found out about one robot.
pub struct Row {
    pub name: String,
    pub joints: usize,
    /// Of inverse dynamics, forward dynamics and the mass matrix.
    pub flops: [u32; 3],
    /// Bytes of generated code.
    pub source: usize,
    /// Seconds that the generator takes.
    pub generating: f64,
    /// Seconds to compile beyond an empty crate.
    pub dev: f64,
    pub release: f64,
    pub sizes: Sizes,
    /// ns for a call of inverse and of forward dynamics.
    pub times: [f64; 2],
    /// The same for one of eight states in lanes.
    pub in_lanes: [f64; 2],
    plain: Built,
    lanes: Option<Built>,
}

impl Empty {
    /// Builds a crate that depends on redysim and does not use it.
    pub fn measured() -> Self {
        let package = Package::new("empty", &[("src/main.rs", "fn main() {}")]);
        let [dev, release, native] = [Profile::Dev, Profile::Release, Profile::Native].map(|it| best(&package, it));
        let text = sizes::of(&native.program).text;
        Empty { dev: dev.seconds, release: release.seconds, native: native.seconds, text }
    }
}

impl Row {
    /// Builds the robot described by `model` in every profile, as a user would.
    pub fn built(name: &str, joints: usize, model: &str, empty: &Empty) -> Self {
        eprintln!("building {name}");
        let code = generated::code(model, &Passes::all());
        let package = |name: &str, main: &str| {
            let files =
                [("src/main.rs", main), ("src/speed.rs", SPEED), ("src/robot.rs", MACRO), ("model.toml", model)];
            Package::new(name, &files)
        };
        let all = package(name, ALL_FUNCTIONS);
        let [dev, release, plain] = [Profile::Dev, Profile::Release, Profile::Native].map(|it| best(&all, it));
        assert!(!dev.warnings, "{name} compiles with warnings");
        dev.run(1);
        let lanes = package(&format!("{name}-lanes"), IN_LANES).build(Profile::Native);
        let seconds = [code.seconds, dev.seconds - empty.dev, release.seconds - empty.release];
        Row::new(name, joints, &code, seconds, plain, Some(lanes))
    }

    /// The robot from its generated source for this machine, so that passes can be switched.
    pub fn from_source(name: &str, joints: usize, model: &str, passes: &Passes, empty: &Empty) -> Self {
        eprintln!("building {name}");
        let code = generated::code(model, passes);
        let files = [("src/main.rs", ALL_FUNCTIONS), ("src/speed.rs", SPEED), ("src/robot.rs", &code.source)];
        let plain = best(&Package::new(name, &files), Profile::Native);
        let seconds = [code.seconds, f64::NAN, plain.seconds - empty.native];
        Row::new(name, joints, &code, seconds, plain, None)
    }

    fn new(
        name: &str,
        joints: usize,
        code: &generated::Code,
        [generating, dev, release]: [f64; 3],
        plain: Built,
        lanes: Option<Built>,
    ) -> Self {
        let (name, sizes) = (name.to_owned(), sizes::of(&plain.program));
        let (flops, source) = (code.flops, code.source.len());
        let [times, in_lanes] = [[f64::INFINITY; 2]; 2];
        Row { name, joints, flops, source, generating, dev, release, sizes, times, in_lanes, plain, lanes }
    }

    /// Runs the programs once; the shortest times so far are kept.
    pub fn run(&mut self) {
        shorten(&mut self.times, self.plain.run(BATCHES));
        if let Some(lanes) = &self.lanes {
            shorten(&mut self.in_lanes, lanes.run(BATCHES).map(|time| time / LANES));
        }
    }
}

fn shorten(shortest: &mut [f64; 2], times: [f64; 2]) {
    shortest.iter_mut().zip(times).for_each(|(shortest, time)| *shortest = shortest.min(time));
}

fn best(package: &Package, profile: Profile) -> Built {
    let built = package.build(profile);
    if built.seconds > QUICK {
        return built;
    }
    let again = package.build(profile);
    Built { seconds: again.seconds.min(built.seconds), warnings: built.warnings || again.warnings, ..built }
}
