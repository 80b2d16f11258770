//! How the functions of a mechanism are computed: one state after another, and many on all cores.

use crate::arrays::{Inputs, Output};
use crate::compiled::Entry;
use pyo3::prelude::*;
use redysim_model::denoc::{self, Untraced};
use redysim_model::{Function, Model, RunTimeParameter, Tree};
use std::marker::PhantomData;
use std::ops::Range;
use std::ptr;
use std::slice;
use std::sync::LazyLock;
use std::thread;

/// How many states a thread computes at least, by the recursions and by compiled code: what takes some ten times as long as
/// to start the thread.
const SHARE: usize = 256;
const COMPILED_SHARE: usize = 4096;
/// States of a thread are a multiple of it, so that they fill the lanes of vectors.
const LANES: usize = 8;

/// The arguments of a function, and what stands for run-time parameters.
const ARRAYS: usize = 4;

/// Who computes the states.
#[derive(Clone, Copy)]
pub enum Evaluator<'a> {
    /// The recursions over the tree of one robot.
    Tree(&'a Tree),
    /// The recursions over the tree of a robot for each state.
    Trees(&'a Model, &'a [RunTimeParameter]),
    /// Compiled code.
    Compiled(Entry),
}

/// Numbers of robots: none, or those of one after the other.
#[derive(Clone, Copy)]
pub struct OfRobots<'a> {
    pub numbers: &'a [f64],
    /// How many robots there are; `None` for one that counts for all states.
    pub count: Option<usize>,
}

/// Where arguments and results are, whichever thread computes them.
#[derive(Clone, Copy)]
struct Memory<'a> {
    /// How many arguments there are.
    count: usize,
    /// Where the numbers of each argument begin.
    data: [*const f64; ARRAYS],
    /// How many a state has.
    lengths: [usize; ARRAYS],
    /// How far it is from one state to the next.
    strides: [usize; ARRAYS],
    result: *mut f64,
    length: usize,
    _arrays: PhantomData<&'a f64>,
}

// SAFETY: threads write to the results of different states, and the arguments are only read: `arrays::output` has found
// that they do not overlap.
unsafe impl Send for Memory<'_> {}
unsafe impl Sync for Memory<'_> {}

impl<'a> Memory<'a> {
    fn new(inputs: &'a Inputs, output: &'a Output, robots: OfRobots<'a>) -> Self {
        let count = inputs.iter().count();
        let mut memory = Memory {
            count: count + 1,
            data: [ptr::null(); ARRAYS],
            lengths: [0; ARRAYS],
            strides: [0; ARRAYS],
            result: output.data,
            length: output.length,
            _arrays: PhantomData,
        };
        for (index, input) in inputs.iter().enumerate() {
            (memory.data[index], memory.lengths[index], memory.strides[index]) =
                (input.data, input.length, input.stride());
        }
        let length = robots.numbers.len() / robots.count.unwrap_or(1).max(1);
        (memory.data[count], memory.lengths[count]) = (robots.numbers.as_ptr(), length);
        memory.strides[count] = if robots.count.is_some() { length } else { 0 };
        memory
    }

    /// The same from a state on.
    ///
    /// # Safety
    /// The arrays have that state.
    unsafe fn from(mut self, state: usize) -> Self {
        for (data, stride) in self.data[..self.count].iter_mut().zip(self.strides) {
            // SAFETY: the state is within the array.
            *data = unsafe { data.add(state * stride) };
        }
        // SAFETY: as above.
        self.result = unsafe { self.result.add(state * self.length) };
        self
    }

    /// The arguments of the first state, and behind them the numbers of its robot.
    ///
    /// # Safety
    /// The arrays have a state.
    unsafe fn arrays(&self) -> [&[f64]; ARRAYS] {
        let mut arguments: [&[f64]; ARRAYS] = [&[]; ARRAYS];
        for (index, argument) in arguments.iter_mut().enumerate().take(self.count) {
            // SAFETY: the array has as many numbers for a state.
            *argument = unsafe { slice::from_raw_parts(self.data[index], self.lengths[index]) };
        }
        arguments
    }
}

impl Evaluator<'_> {
    /// Writes the results of `function` for every state; other threads of Python run meanwhile if there are several.
    pub fn evaluate(self, py: Python<'_>, function: Function, inputs: &Inputs, robots: OfRobots<'_>, output: &Output) {
        let memory = Memory::new(inputs, output, robots);
        let count = output.count;
        if count == 1 {
            // One state takes about as long as it takes to release the interpreter's lock and to get it back.
            self.states(function, memory, 0..1);
        } else {
            py.detach(|| self.on_all_cores(function, memory, count));
        }
    }

    fn on_all_cores(self, function: Function, memory: Memory<'_>, count: usize) {
        // Asked once, since it reads files.
        static CORES: LazyLock<usize> = LazyLock::new(|| thread::available_parallelism().map_or(1, usize::from));
        // Threads of their own, not of a pool, which a process that is forked from this one would lack.
        let share = if matches!(self, Evaluator::Compiled(_)) { COMPILED_SHARE } else { SHARE };
        let part = count.div_ceil((*CORES).min(count.div_ceil(share)).max(1)).next_multiple_of(LANES).max(LANES);
        thread::scope(|scope| {
            for start in (part..count).step_by(part) {
                scope.spawn(move || self.states(function, memory, start..(start + part).min(count)));
            }
            self.states(function, memory, 0..part.min(count));
        });
    }

    fn states(self, function: Function, memory: Memory<'_>, states: Range<usize>) {
        if let Evaluator::Compiled(entry) = self {
            // SAFETY: `states` are among those of the arrays.
            unsafe { run(entry, memory, states) };
            return;
        }
        for state in states {
            // SAFETY: `states` are among those of the arrays.
            let memory = unsafe { memory.from(state) };
            // SAFETY: as above.
            let arrays = unsafe { memory.arrays() };
            let (arguments, of_robot) = arrays.split_at(memory.count - 1);
            let values = match self {
                Evaluator::Tree(tree) => denoc::evaluate(function, tree, &Untraced, arguments),
                Evaluator::Trees(model, parameters) => {
                    let tree = Tree::with_parameters(model, parameters, of_robot[0]);
                    denoc::evaluate(function, &tree, &Untraced, arguments)
                }
                Evaluator::Compiled(_) => return,
            };
            assert_eq!(values.len(), memory.length, "{function}");
            // SAFETY: the array has as many numbers for the state, which no other thread writes.
            unsafe { slice::from_raw_parts_mut(memory.result, memory.length) }.copy_from_slice(&values);
        }
    }
}

/// Runs compiled code for `states`.
///
/// # Safety
/// The arrays have these states, and as many numbers for each as the code takes and gives.
unsafe fn run(entry: Entry, memory: Memory<'_>, states: Range<usize>) {
    if states.is_empty() {
        return;
    }
    // SAFETY: the caller answers for it.
    unsafe {
        let first = memory.from(states.start);
        entry(states.len(), first.data.as_ptr(), first.strides.as_ptr(), first.result);
    }
}
