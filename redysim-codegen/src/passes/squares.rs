//! sin² + cos² = 1: in a sum, a s² x + b c² x is b x + (a − b) s² x, for the sine s and the cosine c of one angle.
//!
//! Terms are compared as monomials, so that (s x)² + (c x)² is found as well. Only a product that nothing else uses is
//! replaced.

use super::terms::with_sums;
use crate::expressions::Expressions;
use crate::graph::{Edge, Graph, Node, sum_without_noise};

/// A constant and the factors that are not products, in order.
#[derive(Clone, Debug, PartialEq)]
struct Monomial {
    coefficient: f64,
    factors: Vec<usize>,
}

/// The expressions with squares of sines and cosines of one angle merged.
pub fn merged(expressions: &Expressions) -> Expressions {
    let old = &expressions.graph;
    let uses = expressions.uses();
    with_sums(expressions, |graph, terms, mapped| {
        let mut open: Vec<Edge> = terms.to_vec();
        let mut sum = Vec::new();
        while let Some(Match { sine, cosine, difference, common }) = matching(old, &uses, &open) {
            let rest = common.factors.iter().fold(graph.constant(common.coefficient), |product, &factor| {
                let factor = mapped(old.edge(factor));
                graph.multiply(product, factor)
            });
            sum.push(rest);
            let (sine_edge, cosine_edge) = (open[sine], open[cosine]);
            open.retain(|&term| term != sine_edge && term != cosine_edge);
            if difference != 0.0 {
                let (_, base) = old.coefficient(sine_edge);
                let scale = graph.constant(difference / monomial(old, base).coefficient);
                sum.push(graph.multiply(scale, mapped(base)));
            }
        }
        open.into_iter().map(mapped).chain(sum).fold(graph.constant(0.0), |sum, term| graph.add(sum, term))
    })
}

/// Two terms a s² x and b c² x of a sum.
struct Match {
    sine: usize,
    cosine: usize,
    /// a − b.
    difference: f64,
    /// b x.
    common: Monomial,
}

fn matching(graph: &Graph, uses: &[usize], terms: &[Edge]) -> Option<Match> {
    let monomials: Vec<Monomial> = terms.iter().map(|&term| monomial(graph, term)).collect();
    for (cosine, with_cosine) in monomials.iter().enumerate() {
        if uses[terms[cosine].node()] != 1 {
            continue;
        }
        for angle in squares(graph, with_cosine, |node| if let Node::Cos(angle) = node { Some(angle) } else { None }) {
            let Some(common) = without_square(graph, with_cosine, Node::Cos(angle)) else { continue };
            for (sine, with_sine) in monomials.iter().enumerate() {
                let Some(same) = without_square(graph, with_sine, Node::Sin(angle)) else { continue };
                let difference = sum_without_noise(with_sine.coefficient, -with_cosine.coefficient);
                // With another coefficient the square of the sine stays, so there must be no new product for x.
                let pays = difference == 0.0 || common.factors.len() <= 1;
                if same.factors == common.factors && pays && (difference != 0.0 || uses[terms[sine].node()] == 1) {
                    return Some(Match { sine, cosine, difference, common });
                }
            }
        }
    }
    None
}

/// The angles of whose function, given by `angle`, the monomial has a square.
fn squares(graph: &Graph, of: &Monomial, angle: impl Fn(Node) -> Option<Edge>) -> Vec<Edge> {
    let pairs = of.factors.windows(2).filter(|pair| pair[0] == pair[1]);
    pairs.filter_map(|pair| angle(graph.node(pair[0]))).collect()
}

fn without_square(graph: &Graph, of: &Monomial, square: Node) -> Option<Monomial> {
    let node = graph.index_of(square)?;
    let first = of.factors.iter().position(|&factor| factor == node)?;
    let mut factors = of.factors.clone();
    factors.remove(first);
    (factors.get(first) == Some(&node)).then(|| {
        factors.remove(first);
        Monomial { factors, ..of.clone() }
    })
}

fn monomial(graph: &Graph, edge: Edge) -> Monomial {
    const MOST_FACTORS: usize = 8;
    let mut coefficient = 1.0;
    let mut factors = Vec::new();
    let mut open = vec![edge];
    while let Some(edge) = open.pop() {
        if edge.is_negative() {
            coefficient = -coefficient;
        }
        match graph.node(edge.node()) {
            Node::Multiply(a, b) if factors.len() + open.len() < MOST_FACTORS => open.extend([a, b]),
            Node::Constant(bits) => coefficient *= f64::from_bits(bits),
            _ => factors.push(edge.node()),
        }
    }
    factors.sort_unstable();
    Monomial { coefficient, factors }
}
