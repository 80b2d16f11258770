//! How a function computes the sines and cosines that it reads.

use super::angles::{angle, without_turns};
use super::body::{COS, SIN, local};
use crate::mechanism::TrigProgram;
use crate::program::{Program, Statement};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;
use std::collections::HashMap;

/// The numbers of a vector of 256 bits, the widest in code for one state.
const VECTOR: usize = 4;

/// The statements that compute the sines and cosines of the angles.
pub fn sines_and_cosines(trig: &TrigProgram) -> TokenStream {
    let (turns_taken_off, angles) = (turns_taken_off(trig), trig.angles.iter().map(angle));
    quote!(#turns_taken_off let (sin, cos) = S::sin_cos_all([#(#angles),*]);)
}

/// The statements that compute the sines and cosines that a function reads, in the order of `trig`, and expressions for the arrays
/// of those of all angles, with zeros for the others.
pub fn of_function(trig: &TrigProgram) -> (Option<TokenStream>, TokenStream, TokenStream) {
    let computed = (!trig.angles.is_empty()).then(|| sines_and_cosines(trig));
    if trig.is_complete() && !trig.angles.is_empty() {
        return (computed, quote!(&sin), quote!(&cos));
    }
    let [sin, cos] = [SIN, COS].map(|array| {
        let array = local(array);
        let elements = trig.places.iter().map(|place| match place.map(Literal::usize_unsuffixed) {
            Some(place) => quote!(#array[#place]),
            None => quote!(S::zero()),
        });
        quote!(&[#(#elements),*])
    });
    (computed, sin, cos)
}

/// The statements before a function that computes its sines and cosines when it reads them, and what it is given. The angles of
/// `trig` are in the order of the function.
pub fn when_read(trig: &TrigProgram, runtime: &TokenStream) -> (TokenStream, TokenStream) {
    let (turns_taken_off, angles) = (turns_taken_off(trig), trig.angles.iter().map(angle));
    let computed = quote! {
        #turns_taken_off
        let angles = [#(#angles),*];
        let (mut sin, mut cos) = #runtime::sines_at_once(&angles);
    };
    (
        computed,
        quote!(&mut #runtime::Sines { angles: ::core::option::Option::Some(&angles), sin: &mut sin, cos: &mut cos }),
    )
}

/// The same for one to which the sines and cosines of all angles are given in `argument`.
pub fn given(trig: &TrigProgram, argument: &Ident, runtime: &TokenStream) -> (TokenStream, TokenStream) {
    let [sin, cos] = [SIN, COS].map(|array| {
        let array = local(array);
        let elements = (0..trig.angles.len()).map(|number| {
            let place = trig.places.iter().position(|place| *place == Some(number)).map(Literal::usize_unsuffixed);
            quote!(#argument.#array[#place])
        });
        quote!([#(#elements),*])
    });
    let computed = quote!(let (mut sin, mut cos) = (#sin, #cos););
    (computed, quote!(&mut #runtime::Sines { angles: ::core::option::Option::None, sin: &mut sin, cos: &mut cos }))
}

/// The statement that takes whole turns off coordinates.
fn turns_taken_off(TrigProgram { without_turns: coordinates, .. }: &TrigProgram) -> Option<TokenStream> {
    let (q, names) = (local("q"), coordinates.iter().map(|&coordinate| without_turns(coordinate)));
    let places = coordinates.iter().map(|&coordinate| Literal::u32_unsuffixed(coordinate));
    (!coordinates.is_empty()).then(|| quote!(let [#(#names),*] = S::without_turns([#(#q[#places]),*]);))
}

/// The same angles in the order in which their sines and cosines are best computed, one vector after the other: those that
/// `program` reads first come first, so that it begins while the others are computed, and branches side by side read a vector as
/// it was computed. In a vector the angles keep their order, since coordinates in a row are loaded at once.
pub fn in_order_of_reading(trig: &TrigProgram, program: &Program) -> TrigProgram {
    let mut order: Vec<usize> = Vec::with_capacity(trig.angles.len());
    // Loops read angles by the number of their group, and outputs last.
    let others = trig.places.iter().copied();
    for index in angles_as_read(&program.statements).map(|angle| trig.places[angle]).chain(others).flatten() {
        if !order.contains(&index) {
            order.push(index);
        }
    }
    order.chunks_mut(VECTOR).for_each(<[usize]>::sort_unstable);
    let place = |index: usize| order.iter().position(|&other| other == index);
    TrigProgram {
        without_turns: trig.without_turns.clone(),
        angles: order.iter().map(|&index| trig.angles[index].clone()).collect(),
        places: trig.places.iter().map(|index| index.and_then(place)).collect(),
    }
}

/// The angles of the mechanism whose sines and cosines the statements read, in the order in which they do.
fn angles_as_read(statements: &[Statement]) -> impl Iterator<Item = usize> {
    let mut names: HashMap<&str, usize> = HashMap::new();
    let mut read = Vec::new();
    for statement in statements {
        if let Statement::Destructure { names: elements, .. } = statement {
            names.extend(elements.iter().enumerate().filter_map(|(angle, name)| Some((name.as_deref()?, angle))));
        }
        statement.reads(&mut |name| read.extend(names.get(name)));
    }
    read.into_iter()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::angles::{Angle, Term};
    use crate::program::{Input, SideBySide, Trig, Value};

    /// Each of `places` is the angle of the mechanism that is the coordinate of that number; `None` is not needed.
    fn coordinates(places: Vec<Option<usize>>) -> TrigProgram {
        let of = |coordinate| Term { coordinate, factor: 1.0, without_turns: false };
        let needed = (0..).zip(&places).filter(|(_, place)| place.is_some());
        let angles = needed.map(|(coordinate, _)| Angle { terms: vec![of(coordinate)], constant: 0.0 });
        TrigProgram { without_turns: Vec::new(), angles: angles.collect(), places }
    }

    fn variable(name: &str) -> Value {
        Value::Variable(name.into())
    }

    /// A program that reads the sines of these angles one after the other.
    fn reading(angles: &[usize], all: usize) -> Program {
        let name = |angle: usize| format!("sin_{angle}");
        let names = (0..all).map(|angle| angles.contains(&angle).then(|| name(angle))).collect();
        let destructure = Statement::Destructure { array: Trig::Sines, names };
        let read = angles.iter().map(|&angle| {
            let value = Value::Product(Box::new(Value::Constant(2.0)), Box::new(variable(&name(angle))));
            Statement::Let { name: format!("twice_{angle}"), value }
        });
        Program { statements: std::iter::once(destructure).chain(read).collect(), outputs: Vec::new() }
    }

    fn code(trig: &TrigProgram, program: &Program) -> [String; 2] {
        let (computed, sines, _) = of_function(&in_order_of_reading(trig, program));
        [computed.unwrap_or_default(), sines].map(|tokens| tokens.to_string().replace(' ', ""))
    }

    #[test]
    fn what_is_read_last_is_computed_last_and_vectors_keep_the_order_of_coordinates() {
        let trig = coordinates((0..5).map(Some).collect());
        let [computed, sines] = code(&trig, &reading(&[4, 0, 2, 1, 3], 5));
        assert_eq!(computed, "let(sin,cos)=S::sin_cos_all([q[0],q[1],q[2],q[4],q[3]]);");
        assert_eq!(sines, "&[sin[0],sin[1],sin[2],sin[4],sin[3]]");
        let [computed, sines] = code(&trig, &reading(&[3, 2, 1, 0, 4], 5));
        assert_eq!(computed, "let(sin,cos)=S::sin_cos_all([q[0],q[1],q[2],q[3],q[4]]);");
        assert_eq!(sines, "&sin");
    }

    #[test]
    fn angles_that_are_not_needed_are_zero_and_those_that_only_loops_read_come_last() {
        let trig = coordinates(vec![Some(0), None, Some(1), Some(2), Some(3), Some(4), Some(5)]);
        let [computed, sines] = code(&trig, &reading(&[6, 5, 4, 3], 7));
        assert_eq!(computed, "let(sin,cos)=S::sin_cos_all([q[3],q[4],q[5],q[6],q[0],q[2]]);");
        assert_eq!(sines, "&[sin[4],S::zero(),sin[5],sin[0],sin[1],sin[2],sin[3]]");
    }

    #[test]
    fn four_branches_read_a_vector_as_it_is_computed() {
        // Two joints of each of four legs, the outer ones first.
        let names: [String; 8] = std::array::from_fn(|angle| format!("sin_{angle}"));
        let input =
            |legs: [usize; 4]| Input { name: "sin".into(), branches: legs.map(|angle| variable(&names[angle])).into() };
        let side_by_side = SideBySide {
            name: "legs".into(),
            branches: 4,
            inputs: [[1, 3, 5, 7], [0, 2, 4, 6]].map(input).into(),
            body: Vec::new(),
            results: Vec::new(),
        };
        let destructure = Statement::Destructure { array: Trig::Sines, names: names.clone().map(Some).into() };
        let statements = vec![destructure, Statement::SideBySide(side_by_side)];
        let program = Program { statements, outputs: Vec::new() };
        let [computed, _] = code(&coordinates((0..8).map(Some).collect()), &program);
        assert_eq!(computed, "let(sin,cos)=S::sin_cos_all([q[1],q[3],q[5],q[7],q[0],q[2],q[4],q[6]]);");
    }
}
