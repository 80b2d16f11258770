//! Operations of the graph as values.

use super::build::Builder;
use super::names::carried;
use super::{Index, Scope, Trig, Value};
use crate::graph::{Edge, Node};
use crate::reroll::{Constant, TEMPLATE};

/// An operand of an operation.
#[derive(Clone, Copy)]
struct Operand {
    edge: Edge,
    /// The operation.
    user: usize,
    /// Which of its operands.
    number: usize,
}

impl Operand {
    fn flipped_if(self, flip: bool) -> Operand {
        Operand { edge: self.edge.flipped_if(flip), ..self }
    }
}

impl Builder<'_> {
    /// A value: a variable that has it, or its operations.
    pub fn value(&self, edge: Edge, scope: Scope) -> Value {
        let index = edge.node();
        if let Some(value) = self.graph.constant_value(edge) {
            return Value::Constant(value);
        }
        let signed = |value: Value, negative: bool| if negative { value.negated() } else { value };
        if let Some((negative, value)) = self.loop_value(index, scope) {
            return signed(value, edge.is_negative() != negative);
        }
        let negative = edge.is_negative() != self.flipped[index];
        if let Some(name) = &self.variables[index] {
            return signed(Value::Variable(name.clone()), negative);
        }
        match self.graph.node(index) {
            Node::Input { argument, index } => {
                let index = self.element(index as usize, scope);
                signed(Value::Argument(usize::from(argument), index), negative)
            }
            Node::Parameter { index, .. } => signed(Value::Given(index as usize), negative),
            Node::Sin(_) if self.is_given(index) => signed(self.trig(Trig::Sines, index, scope), negative),
            Node::Cos(_) if self.is_given(index) => signed(self.trig(Trig::Cosines, index, scope), negative),
            Node::Subtract(..) => self.operation(index, edge.is_negative(), scope),
            _ => signed(self.operation(index, false, scope), negative),
        }
    }

    /// The operation of a node; of a subtraction, the other way round if `flip`.
    pub fn operation(&self, user: usize, flip: bool, scope: Scope) -> Value {
        let operand = |edge, number| Operand { edge, user, number };
        let boxed = |edge, number| Box::new(self.operand(operand(edge, number), scope));
        match self.graph.node(user) {
            Node::Add(a, b) => self.sum(operand(a, 0), operand(b, 1), scope),
            Node::Subtract(a, b) => self.sum(operand(a, 0).flipped_if(flip), operand(b, 1).flipped_if(!flip), scope),
            Node::Multiply(a, b) => Value::Product(boxed(a, 0), boxed(b, 1)),
            Node::Divide(a, b) => Value::Quotient(boxed(a, 0), boxed(b, 1)),
            Node::Sqrt(a) => Value::SquareRoot(boxed(a, 0)),
            Node::Sin(a) => Value::Sine(boxed(a, 0)),
            Node::Cos(a) => Value::Cosine(boxed(a, 0)),
            Node::Input { .. } | Node::Constant(_) | Node::Parameter { .. } => {
                unreachable!("inputs, parameters and constants are not operations")
            }
        }
    }

    /// a + b: fused where one of them is a product for it, else with a minus sign between them where one has it.
    fn sum(&self, a: Operand, b: Operand, scope: Scope) -> Value {
        for (product, addend) in [(a, b), (b, a)] {
            let node = product.edge.node();
            if self.fused[node]
                && let Node::Multiply(x, y) = self.graph.node(node)
            {
                let x = Operand { edge: x.flipped_if(product.edge.is_negative()), user: node, number: 0 };
                let y = Operand { edge: y, user: node, number: 1 };
                let [x, y, addend] = [x, y, addend].map(|operand| Box::new(self.operand(operand, scope)));
                return Value::MultiplyAdd(x, y, addend);
            }
        }
        let [a, b] = [a, b].map(|operand| self.operand(operand, scope));
        Value::sum(a, b)
    }

    /// An operand: in a loop, constants come from its table.
    fn operand(&self, Operand { edge, user, number }: Operand, scope: Scope) -> Value {
        let constant = self.rerolled.as_ref().and_then(|rerolled| rerolled.constant(user, number));
        let value = match (scope, constant) {
            (Scope::Sweep(_), Some(Constant::Same(value))) => Value::Constant(value),
            (Scope::Sweep(_), Some(Constant::Column(column))) => Value::GroupConstant(column),
            _ => return self.value(edge, scope),
        };
        if edge.is_negative() { value.negated() } else { value }
    }

    fn trig(&self, array: Trig, node: usize, scope: Scope) -> Value {
        Value::Trig(array, self.element(self.positions[&node], scope))
    }

    /// Where element `index` of an array is, which in a loop depends on the group.
    fn element(&self, index: usize, scope: Scope) -> Index {
        match (scope, &self.rerolled) {
            (Scope::Sweep(_), Some(rerolled)) => {
                Index::OfGroup { first: index - TEMPLATE * rerolled.period, period: rerolled.period }
            }
            _ => Index::At(index),
        }
    }

    /// A value that a loop computes, as it is read in `scope`, and whether the value wanted is its negative; `None` for
    /// a value of the template in its own loop, and for one that no loop computes.
    fn loop_value(&self, index: usize, scope: Scope) -> Option<(bool, Value)> {
        let of_branches = self.side_by_side.as_ref().and_then(|all| Some((all, all.member(index)?)));
        if let Some((side_by_side, member)) = of_branches {
            let result = Value::OfBranch {
                array: self.arrays[member.part].clone(),
                branches: side_by_side.siblings[side_by_side.parts[member.part].siblings].branches,
                branch: member.branch,
                column: member.result,
            };
            return Some((member.negative, result));
        }
        let rerolled = self.rerolled.as_ref()?;
        let place = rerolled.place(index)?;
        let name = self.variables[place.template].as_ref();
        let value = match scope {
            Scope::Sweep(sweep) if sweep == place.sweep && place.group == TEMPLATE => return None,
            Scope::Sweep(sweep) if sweep == place.sweep => Value::Variable(carried(name?)),
            Scope::Sweep(_) => Value::Variable(name?.clone()),
            Scope::Outside if place.group == rerolled.last_group(place.sweep) => Value::Variable(carried(name?)),
            Scope::Outside => {
                let live_out = &rerolled.sweeps[place.sweep].live_out;
                let column = live_out.iter().position(|&node| node == place.template)?;
                Value::LiveOut(self.arrays[place.sweep].clone(), place.group, column)
            }
        };
        Some((place.negative, value))
    }
}
