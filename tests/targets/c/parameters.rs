//! Run-time parameters in C: they give the bits that they give in Rust, and are checked by the same rules.

use super::compilers::compilers;
use super::program::InC;
use super::{same_bits, tree, trig};
use redysim::{Dual, Lift, Real, redysim};
use redysim_codegen::CScalar;

redysim! { pub struct Given("models/gripper.toml", parameters = ["gravity", "link3.mass", "link3.com", "link3.inertia", "joint2.damping"]); }

/// The options of [`Given`].
pub const OF_GIVEN: &str =
    "parameters = [\"gravity\", \"link3.mass\", \"link3.com\", \"link3.inertia\", \"joint2.damping\"]";

/// Of what acts in the joints of `models/test/bushing.toml`.
pub const OF_WORN: &str = "parameters = [\"hull.damping\", \"ball.stiffness\", \"ball.rest\"]";

/// Compares what `try_init` returns for each list with `expected`.
pub fn assert_statuses<const N: usize>(in_c: &InC, lists: &[[f64; N]], expected: &[usize]) {
    let lists: Vec<Vec<f64>> = lists.iter().map(|list| list.to_vec()).collect();
    compilers().iter().for_each(|compiler| assert_eq!(in_c.statuses(compiler, &lists), expected, "{compiler}"));
}

#[test]
fn run_time_parameters_give_the_same_bits_in_c() {
    fn compare<T: Real + Lift<T> + Lift<Dual<T>>>(scalar: CScalar) {
        let in_c = InC::new("gripper", OF_GIVEN, scalar);
        let robot = Given::<T>::default();
        same_bits::<T>(&in_c, &robot, trig!(robot.joint_trig), &|function, state| tree(&robot, function, state));
    }
    compare::<f64>(CScalar::F64);
    compare::<f32>(CScalar::F32);
}

#[test]
fn run_time_parameters_are_checked_in_c_as_in_rust() {
    fn compare<T: Real>(scalar: CScalar) {
        let in_c = InC::new("gripper", OF_GIVEN, scalar);
        let mut lists = vec![Given::PARAMETERS];
        for index in 0..Given::NP {
            // With a tensor that no body has, a negative number, and one that is not finite.
            lists.extend([-1.0, 1e-3, f64::NAN].map(|number| {
                let mut list = Given::PARAMETERS;
                list[index] = number;
                list
            }));
        }
        // With a tensor, of which this is yy, that is one within the roundoff of `f32` alone.
        lists.push(Given::PARAMETERS);
        lists.last_mut().expect("a list")[8] *= 1.0 + 2e-6;
        let status = |list: &[f64; Given::NP]| {
            Given::try_new(&list.map(T::from_f64)).map_or_else(|error| error.index + 1, |_| 0)
        };
        let expected: Vec<usize> = lists.iter().map(status).collect();
        assert!(expected.contains(&0) && expected.iter().filter(|&&status| status > 0).count() > Given::NP);
        assert_eq!(expected.last() == Some(&0), scalar == CScalar::F32);
        assert_statuses(&in_c, &lists, &expected);
    }
    compare::<f64>(CScalar::F64);
    compare::<f32>(CScalar::F32);
}

#[test]
fn run_time_parameters_have_units_in_c() {
    let units = |model: &str, options: &str| -> Vec<String> {
        let source = InC::new(model, options, CScalar::F64).source();
        let (_, table) = source.split_once("_parameter_units[").expect("the table");
        let lines = table.lines().skip(1).take_while(|line| *line != "};");
        // As C has the letter ² in UTF-8.
        lines.map(|line| line.trim_matches([' ', '"', ',']).replace("\\302\\262", "²")).collect()
    };
    let of_inertia = ["kg m²"; 6];
    let of_gripper = [&["m/s²"; 3][..], &["kg"], &["m"; 3], &of_inertia, &["N m s/rad"]].concat();
    assert_eq!(units("gripper", OF_GIVEN), of_gripper);
    let of_hull = [["N s/m"; 3], ["N m s/rad"; 3]].concat();
    let of_ball = [&["N m/rad"; 3][..], &["1"; 4]].concat();
    assert_eq!(units("test/bushing", OF_WORN), [of_hull, of_ball].concat());
}
