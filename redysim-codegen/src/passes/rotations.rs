//! Squares of rotated components: a rotation keeps x² + y² of the components that it turns, so that y′² + u is
//! (x² + y²) + (u − x′²), one multiplication less where both sums are computed anyway.
//!
//! Such squares are in the centripetal accelerations of consecutive bodies that turn about all axes.

use crate::expressions::Expressions;
use crate::graph::{Edge, Graph, Node};
use std::collections::{HashMap, HashSet};

/// The expressions with such sums replaced.
pub fn replaced(expressions: &Expressions) -> Expressions {
    let (old, uses) = (&expressions.graph, expressions.uses());
    let replacements = replacements(old, &uses);
    if replacements.is_empty() {
        return expressions.clone();
    }
    expressions.rebuilt(
        |index| uses[index] > 0,
        |graph, index, mapped| {
            let edge = match replacements.get(&index) {
                Some(replacement) => {
                    let Replacement { turned: [x, y], partner, other, negative } = *replacement;
                    let [x, y, partner] = [x, y, partner].map(|value| graph.multiply(mapped(value), mapped(value)));
                    let (kept, rest) = (graph.add(x, y), graph.add(mapped(other), -partner));
                    graph.add(kept, rest).flipped_if(negative)
                }
                None => graph.rebuild(old.node(index), mapped),
            };
            (edge, old.name(index))
        },
    )
}

/// A component of a vector that is turned by an angle: c x + s y or c y − s x, or its negative.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct Component {
    angle: Edge,
    by_cosine: Edge,
    by_sine: Edge,
    is_difference: bool,
}

impl Component {
    fn of(graph: &Graph, value: usize) -> Option<Component> {
        let (a, b, is_difference) = match graph.node(value) {
            Node::Add(a, b) => (a, b, false),
            Node::Subtract(a, b) => (a, b, true),
            _ => return None,
        };
        [(a, b), (b, a)].into_iter().find_map(|(first, second)| {
            let (angle, by_cosine) = cofactor(graph, first, |node| match node {
                Node::Cos(angle) => Some(angle),
                _ => None,
            })?;
            let (_, by_sine) = cofactor(graph, second, |node| match node {
                Node::Sin(same) => (same == angle).then_some(same),
                _ => None,
            })?;
            Some(Component { angle, by_cosine, by_sine, is_difference })
        })
    }

    /// The other component of the same vector.
    fn partner(self) -> Component {
        Component { by_cosine: self.by_sine, by_sine: self.by_cosine, is_difference: !self.is_difference, ..self }
    }
}

/// What `angle` returns for a factor of a product, and the other factor.
fn cofactor(graph: &Graph, product: Edge, angle: impl Fn(Node) -> Option<Edge>) -> Option<(Edge, Edge)> {
    let Node::Multiply(a, b) = graph.node(product.node()) else { return None };
    [(a, b), (b, a)].into_iter().find_map(|(first, second)| Some((angle(graph.node(first.node()))?, second)))
}

/// What a sum y′² + u, or its negative, is replaced by: x² + y² and u − x′².
struct Replacement {
    /// x and y.
    turned: [Edge; 2],
    /// x′.
    partner: Edge,
    /// u.
    other: Edge,
    negative: bool,
}

/// The sums that are replaced, by node.
fn replacements(graph: &Graph, uses: &[usize]) -> HashMap<usize, Replacement> {
    let live = || (0..graph.len()).filter(|&index| uses[index] > 0);
    let components: HashMap<Component, usize> =
        live().filter_map(|index| Some((Component::of(graph, index)?, index))).collect();
    let square = |value: Edge| graph.index_of(Node::Multiply(value, value)).map(|index| graph.edge(index));
    let mut replacements = HashMap::new();
    let mut needed = HashSet::new();
    for index in live() {
        if needed.contains(&index) {
            continue;
        }
        let computed = |a: Edge, b: Edge| {
            graph.index_of_sum(a, b).filter(|sum| uses[*sum] > 0 && *sum != index && !replacements.contains_key(sum))
        };
        let found = squares(graph, uses, index).into_iter().find_map(|(value, other, negative)| {
            let component = Component::of(graph, value.node())?;
            let partner = graph.edge(*components.get(&component.partner()).filter(|&&partner| partner < index)?);
            let turned = [component.by_cosine, component.by_sine];
            let kept = computed(square(turned[0])?, square(turned[1])?)?;
            let rest = computed(other, -square(partner)?)?;
            Some(([kept, rest], Replacement { turned, partner, other, negative }))
        });
        if let Some((sums, replacement)) = found {
            needed.extend(sums);
            replacements.insert(index, replacement);
        }
    }
    replacements
}

/// The squares in a sum that nothing else uses: the value that is squared, the other term u, and whether the sum is the
/// negative of the square and u.
fn squares(graph: &Graph, uses: &[usize], sum: usize) -> Vec<(Edge, Edge, bool)> {
    let terms = match graph.node(sum) {
        Node::Add(a, b) => vec![(a, b, false), (b, a, false)],
        Node::Subtract(a, b) => vec![(a, -b, false), (b, -a, true)],
        _ => Vec::new(),
    };
    let of_square = |(square, other, negative): (Edge, Edge, bool)| match graph.node(square.node()) {
        Node::Multiply(x, y) if x == y && uses[square.node()] == 1 => Some((x, other, negative)),
        _ => None,
    };
    terms.into_iter().filter_map(of_square).collect()
}
