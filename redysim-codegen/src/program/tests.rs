//! A program computes what its graph does. Its statements are executed one by one here, without a backend.

use super::{Index, Loop, NamingContext, Program, SideBySide, Statement, Trig, Value, program};
use crate::angles::Angles;
use crate::functions::trace_with;
use crate::passes::{Passes, simplified};
use crate::siblings::{self, Siblings};
use crate::tracing::tests::{chain_of_40, derivative_on};
use crate::tracing::traced_on;
use redysim_model::{Function, Model, Tree};
use redysim_runtime::Scalar;
use std::collections::HashMap;

/// The state of a program that runs.
struct Run<'a> {
    arguments: &'a [&'a [f64]],
    sines: Vec<f64>,
    cosines: Vec<f64>,
    variables: HashMap<String, f64>,
    /// The live-out values of loops, by group and column.
    arrays: HashMap<String, Vec<Vec<f64>>>,
    /// In a loop: the group and its constants.
    group: Option<(usize, Vec<f64>)>,
}

impl Run<'_> {
    fn trig(&self, array: Trig) -> &[f64] {
        match array {
            Trig::Sines => &self.sines,
            Trig::Cosines => &self.cosines,
        }
    }

    fn place(&self, index: Index) -> usize {
        match (index, &self.group) {
            (Index::At(place), _) => place,
            (Index::OfGroup { first, period }, Some((group, _))) => first + period * group,
            (Index::OfGroup { .. }, None) => panic!("an index of a group outside of a loop"),
        }
    }

    fn value(&self, value: &Value) -> f64 {
        match value {
            Value::Constant(value) => *value,
            Value::GroupConstant(column) => self.group.as_ref().expect("a loop").1[*column],
            Value::Variable(name) => *self.variables.get(name).unwrap_or_else(|| panic!("{name} is not defined")),
            Value::Argument(argument, index) => self.arguments[*argument][self.place(*index)],
            Value::Given(_) => panic!("the robot has no parameters"),
            Value::Trig(array, index) => self.trig(*array)[self.place(*index)],
            Value::LiveOut(array, row, column) | Value::OfBranch { array, branch: row, column, .. } => {
                self.arrays[array][*row][*column]
            }
            Value::Negative(a) => -self.value(a),
            Value::Sum(a, b) => self.value(a) + self.value(b),
            Value::Difference(a, b) => self.value(a) - self.value(b),
            Value::Product(a, b) => self.value(a) * self.value(b),
            Value::Quotient(a, b) => self.value(a) / self.value(b),
            // Rounded twice, as in the graph.
            Value::MultiplyAdd(a, b, c) => self.value(a) * self.value(b) + self.value(c),
            Value::SquareRoot(a) => self.value(a).sqrt(),
            Value::Sine(a) => Scalar::sin_cos(self.value(a)).0,
            Value::Cosine(a) => Scalar::sin_cos(self.value(a)).1,
        }
    }

    fn define(&mut self, name: &str, value: f64) {
        self.variables.insert(name.to_string(), value);
    }

    fn execute(&mut self, statements: &[Statement]) {
        for statement in statements {
            match statement {
                Statement::Destructure { array, names } => {
                    for (element, name) in self.trig(*array).to_vec().into_iter().zip(names) {
                        name.iter().for_each(|name| self.define(name, element));
                    }
                }
                Statement::Let { name, value } => self.define(name, self.value(value)),
                Statement::Block { statements, live_out } => {
                    let before = self.variables.clone();
                    self.execute(statements);
                    let within = std::mem::replace(&mut self.variables, before);
                    live_out.iter().for_each(|name| self.define(name, within[name]));
                }
                Statement::Loop(each) => self.repeat(each),
                Statement::SideBySide(each) => self.each_branch(each),
            }
        }
    }

    fn each_branch(&mut self, each: &SideBySide) {
        let before = self.variables.clone();
        let results = (0..each.branches).map(|branch| {
            let inputs: Vec<f64> = each.inputs.iter().map(|input| self.value(&input.branches[branch])).collect();
            // A branch reads nothing but its inputs.
            self.variables = each.inputs.iter().map(|input| input.name.clone()).zip(inputs).collect();
            self.execute(&each.body);
            let results = each.results.iter().map(|name| self.variables[name]).collect();
            self.variables.clone_from(&before);
            results
        });
        let results = results.collect();
        self.arrays.insert(each.name.clone(), results);
    }

    fn repeat(&mut self, each: &Loop) {
        for carried in &each.carried {
            self.define(&carried.name, self.value(&carried.start));
        }
        let mut live_out = vec![Vec::new(); each.groups];
        for count in 0..each.groups {
            let group = if each.ascending { count } else { each.groups - 1 - count };
            self.group = Some((group, each.constants.get(group).cloned().unwrap_or_default()));
            let before = self.variables.clone();
            for read in &each.reads {
                for (name, value) in read.names.iter().zip(self.arrays[&read.array][group].clone()) {
                    name.iter().for_each(|name| self.define(name, value));
                }
            }
            self.execute(&each.body);
            let within = std::mem::replace(&mut self.variables, before);
            each.carried.iter().for_each(|carried| self.define(&carried.name, within[&carried.next]));
            let columns = each.live_out.iter().flat_map(|array| &array.columns);
            live_out[group] = columns.map(|column| within[column]).collect();
        }
        self.group = None;
        if let Some(array) = &each.live_out {
            self.arrays.insert(array.name.clone(), live_out);
        }
    }
}

/// What the program returns.
fn run(program: &Program, angles: &Angles, arguments: &[&[f64]]) -> Vec<f64> {
    let sines_and_cosines = angles.at(0..angles.len()).map(|angle| {
        let terms = angle.terms.iter().map(|term| term.factor * arguments[0][term.coordinate as usize]);
        Scalar::sin_cos(terms.sum::<f64>() + angle.constant)
    });
    let (sines, cosines) = sines_and_cosines.unzip();
    let (variables, arrays) = Default::default();
    let mut run = Run { arguments, sines, cosines, variables, arrays, group: None };
    run.execute(&program.statements);
    program.outputs.iter().map(|output| run.value(output)).collect()
}

/// The groups of each loop of the program.
fn groups(program: &Program) -> Vec<usize> {
    let groups = program.statements.iter().filter_map(|statement| match statement {
        Statement::Loop(each) => Some(each.groups),
        _ => None,
    });
    groups.collect()
}

/// All 40 bodies but a few at the ends are in the loops: one by one, or, where passes make neighbours differ, by twos.
#[test]
fn loops_over_the_bodies_of_a_chain_compute_the_bits_of_the_graph_and_so_do_those_of_derivatives() {
    let tree = chain_of_40();
    let bodies: Vec<String> = (0..tree.bodies.len()).map(|body| format!("body{body}")).collect();
    let element = |argument: usize, i: usize| (0.9 * argument as f64 + 2.3 * i as f64).sin();
    let arguments: Vec<Vec<f64>> = (0..6).map(|k| (0..tree.nv()).map(|i| element(k, i)).collect()).collect();
    let arguments: Vec<&[f64]> = arguments.iter().map(Vec::as_slice).collect();
    for function in [Function::InverseDynamics, Function::BiasForces, Function::ForwardDynamics] {
        for traced in [traced_on(&tree, function), derivative_on(&tree, function)] {
            for passes in [Passes { loops: true, ..Passes::none() }, Passes::all()] {
                let expressions = simplified(traced.clone(), &passes).expect("no pass changes a value");
                let angles = Angles::of([&expressions]);
                let program =
                    program(&expressions, None, &NamingContext { reserved: &[], bodies: &bodies, angles: &angles });
                let groups = groups(&program);
                assert!(groups.len() >= 2 && groups.iter().all(|&groups| groups >= 16), "{function}: {groups:?}");
                assert_eq!(run(&program, &angles, &arguments), expressions.evaluate(&arguments), "{function}");
            }
        }
    }
}

fn shipped(name: &str) -> Model {
    Model::load(format!("{}/../models/{name}.toml", env!("CARGO_MANIFEST_DIR"))).expect("a valid model").model
}

/// A trunk on a free joint with three limbs of three joints each, of which no two numbers are the same but those that
/// are zero. The second limb is mirrored, and the last joint of the third one turns the other way.
fn three_limbs() -> Model {
    let mut text = String::from("name = 'r'\ngravity = [0, 0, -10]\nallow = ['under-actuated']\n");
    let link = |name: &str, parent: &str, joint: &str, number: f64, side: f64| {
        let [x, y, z] = [0.31, 0.17, 0.23].map(|length| length + 0.01 * number);
        let axis = match name.chars().last() {
            Some('0') => [1.0, 0.0, 0.0],
            Some('1') => [0.0, 1.0, 0.0],
            _ => [0.0, if number > 8.0 { -1.0 } else { 1.0 }, 0.0],
        };
        let joint = match joint {
            "free" => "joint = 'free'\nactuated = false\norigin = {}".to_string(),
            _ => format!("joint = 'revolute'\naxis = {axis:?}\norigin = {{ xyz = [{x}, {}, {z}] }}", side * y),
        };
        format!(
            "[[link]]\nname = '{name}'\nparent = '{parent}'\n{joint}\nmass = {}\ncom = [{z}, {}, {x}]\n\
             inertia = {{ xx = {}, yy = {}, zz = {}, xy = {}, yz = 0.003, xz = 0.002 }}\n",
            1.0 + x,
            side * x,
            0.2 + x,
            0.21 + y,
            0.19 + z,
            side * 0.01 * x
        )
    };
    text += &link("trunk", "base", "free", 0.0, 1.0);
    for (limb, side) in [1.0, -1.0, 1.0].into_iter().enumerate() {
        let mut parent = "trunk".to_string();
        for joint in 0..3 {
            let name = format!("limb{limb}{joint}");
            text += &link(&name, &parent, "revolute", (3 * limb + joint + 1) as f64, side);
            parent = name;
        }
    }
    Model::from_toml(text, "r.toml").unwrap_or_else(|faults| panic!("{faults}")).model
}

/// How many results of branches are more often an output with a minus sign than without.
fn results_with_minus_signs(program: &Program) -> usize {
    let mut signs: HashMap<(&str, usize), i32> = HashMap::new();
    for output in &program.outputs {
        let (result, sign) = match output {
            Value::Negative(result) => (&**result, -1),
            result => (result, 1),
        };
        if let Value::OfBranch { array, column, .. } = result {
            *signs.entry((array, *column)).or_default() += sign;
        }
    }
    signs.values().filter(|sign| **sign < 0).count()
}

/// The functions that have branches side by side.
fn hold_side_by_side(model: &Model) -> Vec<Function> {
    let tree = Tree::new(model);
    let bodies: Vec<String> = (0..tree.bodies.len()).map(|body| format!("body{body}")).collect();
    let siblings = Siblings::of(&tree);
    let mut held = Vec::new();
    for traced in trace_with(&tree, &Passes::all()).expect("no pass changes a value") {
        let (function, expressions) = (traced.function, &traced.expressions);
        let Some(side_by_side) = siblings::SideBySide::of(expressions, function, &siblings) else { continue };
        let arguments = function.signature().arguments.iter().enumerate().map(|(argument, kind)| {
            (0..tree.argument_length(*kind)).map(|i| (0.9 * argument as f64 + 2.3 * i as f64).sin()).collect()
        });
        let arguments: Vec<Vec<f64>> = arguments.collect();
        let arguments: Vec<&[f64]> = arguments.iter().map(Vec::as_slice).collect();
        let angles = Angles::of([expressions]);
        let naming = NamingContext { reserved: &[], bodies: &bodies, angles: &angles };
        let program = program(expressions, Some(&side_by_side), &naming);
        assert!(program.statements.iter().any(|statement| matches!(statement, Statement::SideBySide(_))), "{function}");
        assert_eq!(run(&program, &angles, &arguments), expressions.evaluate(&arguments), "{function}");
        if function == Function::MassMatrix {
            assert_eq!(results_with_minus_signs(&program), 0, "{}", model.name);
        }
        held.push(function);
    }
    held
}

#[test]
fn branches_side_by_side_compute_the_bits_of_the_graph() {
    let dynamics = [Function::InverseDynamics, Function::ForwardDynamics, Function::MassMatrix];
    // The fewer joints a branch has, the more of its mass matrix are numbers that are read one by one.
    let models = [
        (three_limbs(), &dynamics[..]),
        (shipped("quadruped"), &dynamics),
        (shipped("hexapod"), &dynamics[..2]),
        (shipped("biped"), &[]),
        (shipped("walking_biped"), &[]),
    ];
    for (model, expected) in models {
        let held = hold_side_by_side(&model);
        assert!(expected.iter().all(|function| held.contains(function)), "{}: {held:?}", model.name);
    }
}

#[test]
fn robots_without_branches_that_are_alike_have_nothing_side_by_side() {
    assert!(hold_side_by_side(&shipped("kr5")).is_empty());
}
