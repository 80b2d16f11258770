//! The choice of the algorithm for forward dynamics.

use crate::accuracy::Reference;
use crate::expressions::Expressions;
use crate::passes::{PassError, Passes, simplified};
use crate::policies::{LONGEST_CHAIN_BY_FACTORISATION, MOST_LOST_AGAINST_RECURSION, NEGLIGIBLE_LOSS};
use crate::symbol::SymbolicTree;
use crate::tracing::traced;
use crate::trees::Trees;
use redysim_model::denoc::{self, EliminationOrder, Method};
use redysim_model::{AccelerationMethod, Function};

/// One algorithm for forward dynamics.
struct Candidate {
    method: Method,
    expressions: Expressions,
    /// The errors of the accelerations for each motion; see [`Reference::losses_by`].
    losses: [f64; 3],
}

/// The algorithm by which forward dynamics is computed, and its alternative. Displayed, it is a paragraph of the
/// documentation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MethodChoice {
    /// The algorithm that is used.
    pub used: MethodFigures,
    /// The other one, if it was considered.
    pub other: Option<MethodFigures>,
}

/// An algorithm for forward dynamics and what it costs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MethodFigures {
    /// The algorithm.
    pub method: Method,
    /// Its operations.
    pub flops: u32,
    /// Its largest error √M_ii |Δa_i| at sampled states, as a share of the largest √M_jj |a_j|.
    pub loss: f64,
}

/// Forward dynamics by `method`, with the choice. `Auto` is the factorisation if it takes fewer operations and keeps the
/// digits that the recursion keeps, else the recursion.
pub fn choose(
    trees: &Trees,
    method: AccelerationMethod,
    passes: &Passes,
    price: impl Fn(&Expressions) -> usize,
) -> Result<(Expressions, MethodChoice), PassError> {
    let recursion = recursion(trees)?;
    let is_long_chain = trees.plain().depth() > LONGEST_CHAIN_BY_FACTORISATION;
    if is_long_chain && method != AccelerationMethod::Factorisation {
        let used = recursion.figures(0);
        return Ok((recursion.expressions, MethodChoice { used, other: None }));
    }
    let factorisations = factorisations(trees, passes)?;
    let kept = |(loss, least): (f64, f64)| loss <= (MOST_LOST_AGAINST_RECURSION * least).max(NEGLIGIBLE_LOSS);
    let keeps_digits = |way: &Candidate| way.losses.into_iter().zip(recursion.losses).all(kept);
    let best = factorisations.iter().position(keeps_digits);
    let factorise = match method {
        AccelerationMethod::Recursion => false,
        AccelerationMethod::Factorisation => true,
        AccelerationMethod::Auto => {
            best.is_some_and(|best| price(&factorisations[best].expressions) <= price(&recursion.expressions))
        }
    };
    let factorisation = factorisations.into_iter().nth(best.unwrap_or(0)).expect("at least one way");
    // The documentation states the errors of the motion in which the two differ most.
    let factor = |motion: &usize| factorisation.losses[*motion] / recursion.losses[*motion].max(f64::EPSILON);
    let most_different = (0..3).max_by(|a, b| factor(a).total_cmp(&factor(b))).unwrap_or_default();
    let (used, other) = if factorise { (factorisation, recursion) } else { (recursion, factorisation) };
    let [figures, other] = [&used, &other].map(|candidate| candidate.figures(most_different));
    Ok((used.expressions, MethodChoice { used: figures, other: Some(other) }))
}

fn recursion(trees: &Trees) -> Result<Candidate, PassError> {
    // The recursion takes the inertias of the model: regrouped towards the ground they would add up there, and the
    // subtractions on the way would cost the digits for which the recursion is chosen.
    let expressions = trees.keeping_digits(Function::ForwardDynamics)?;
    Ok(Candidate::measured(Method::Recursion, expressions, trees.reference()))
}

/// The ways to factorise, from the cheapest on.
fn factorisations(trees: &Trees, passes: &Passes) -> Result<Vec<Candidate>, PassError> {
    let [forces, matrix] = [trees.bias(), trees.matrix()];
    // One sine and cosine of an angle serve both recursions if they take the same sums of angles.
    let merged = |tree: &SymbolicTree| tree.bodies.iter().map(|body| body.merged_parallel).collect::<Vec<bool>>();
    let alike = merged(forces) == merged(matrix);
    let pairs = [Some([forces, matrix]), (!alike).then_some([forces; 2]), (!alike).then_some([matrix; 2])];
    let orders = || EliminationOrder::all_of(matrix);
    let ways = pairs.into_iter().flatten().flat_map(|pair| orders().map(move |order| (order, pair)));
    let expressions = ways.map(|(order, pair)| {
        let traced = traced(matrix, Function::ForwardDynamics, |tracer, x| {
            let trees = &pair.map(|tree| tracer.tree(tree));
            denoc::forward_dynamics_by_factorisation(order, trees.each_ref(), tracer, x[0], x[1], x[2])
        });
        simplified(traced, passes)
    });
    let mut expressions = expressions.collect::<Result<Vec<_>, _>>()?;
    expressions.sort_by_cached_key(Expressions::price);
    let measured = |expressions| Candidate::measured(Method::Factorisation, expressions, trees.reference());
    Ok(expressions.into_iter().map(measured).collect())
}

impl Candidate {
    fn measured(method: Method, expressions: Expressions, reference: &Reference) -> Self {
        let losses = reference.losses_by(Function::ForwardDynamics, |x| expressions.evaluate(x));
        Candidate { method, expressions, losses }
    }

    fn flops(&self) -> u32 {
        self.expressions.count().flops()
    }

    fn figures(&self, motion: usize) -> MethodFigures {
        MethodFigures { method: self.method, flops: self.flops(), loss: self.losses[motion] }
    }
}

impl MethodFigures {
    fn name(&self) -> &'static str {
        match self.method {
            Method::Factorisation => "factorisation M = U D Uᵀ of the generalised inertia matrix (CRBA)",
            Method::Recursion => "O(n) recursion over articulated bodies (ABA)",
        }
    }
}

impl std::fmt::Display for MethodChoice {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let MethodChoice { used, other } = self;
        write!(f, "By the {}: {} flops, errors of {:.0e}", used.name(), used.flops, used.loss)?;
        match other {
            Some(other) => write!(f, "; the {} takes {}, errors of {:.0e}.", other.name(), other.flops, other.loss)?,
            None => write!(
                f,
                "; the explicit mass matrix is not considered for chains of more than {LONGEST_CHAIN_BY_FACTORISATION}."
            )?,
        }
        write!(f, " Errors are the largest √M_ii |Δa_i| at sampled states, as shares of the largest √M_jj |a_j|.")
    }
}
