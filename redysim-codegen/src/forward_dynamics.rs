//! The two ways to accelerations, and which of them a robot takes.

use crate::accuracy::Reference;
use crate::expressions::Expressions;
use crate::passes::{PassError, Passes, simplified};
use crate::policies::{LONGEST_CHAIN_BY_FACTORISATION, MOST_LOST_AGAINST_RECURSION, NEGLIGIBLE_LOSS};
use crate::symbol::Symbol;
use crate::tracing::traced;
use crate::trees::Trees;
use redysim_model::denoc::{self, Factorisation, Method};
use redysim_model::{AccelerationMethod, Function};

/// One way to accelerations.
struct Way {
    method: Method,
    expressions: Expressions,
    /// The errors of the accelerations for each kind of motion; see [`Reference::losses_by`].
    losses: [f64; 3],
}

/// The way that is taken.
pub struct Chosen {
    /// How accelerations are computed.
    pub expressions: Expressions,
    taken: Described,
    other: Option<Described>,
}

/// What the documentation states of a way.
struct Described {
    method: Method,
    flops: u32,
    lost: f64,
}

/// The way that `asked` names, or the one that takes fewer operations, as long as it is not the factorisation and loses
/// digits that the recursion keeps.
pub fn chosen(trees: &Trees, asked: AccelerationMethod, passes: &Passes) -> Result<Chosen, PassError> {
    let recursion = recursion(trees)?;
    let is_long_chain = trees.plain().depth() > LONGEST_CHAIN_BY_FACTORISATION;
    if is_long_chain && asked != AccelerationMethod::Factorisation {
        let taken = recursion.described(0);
        return Ok(Chosen { expressions: recursion.expressions, taken, other: None });
    }
    let factorisation = factorisation(trees, passes)?;
    let factorise = match asked {
        AccelerationMethod::Recursion => false,
        AccelerationMethod::Factorisation => true,
        AccelerationMethod::Auto => {
            let kept = |(lost, least): (f64, f64)| lost <= (MOST_LOST_AGAINST_RECURSION * least).max(NEGLIGIBLE_LOSS);
            factorisation.flops() <= recursion.flops()
                && factorisation.losses.into_iter().zip(recursion.losses).all(kept)
        }
    };
    // The kind of motion in which the two differ most.
    let factor = |kind: &usize| factorisation.losses[*kind] / recursion.losses[*kind].max(f64::EPSILON);
    let telling = (0..3).max_by(|a, b| factor(a).total_cmp(&factor(b))).unwrap_or_default();
    let (taken, other) = if factorise { (factorisation, recursion) } else { (recursion, factorisation) };
    let [described, other] = [&taken, &other].map(|way| way.described(telling));
    Ok(Chosen { expressions: taken.expressions, taken: described, other: Some(other) })
}

fn recursion(trees: &Trees) -> Result<Way, PassError> {
    // The recursion takes the inertias as they are: moved towards the ground they would pile up there, and what is
    // subtracted from them on the way would cost the digits for which the recursion is chosen.
    let expressions = trees.keeping_digits(Function::ForwardDynamics)?;
    Ok(Way::measured(Method::Recursion, expressions, trees.reference()))
}

fn factorisation(trees: &Trees, passes: &Passes) -> Result<Way, PassError> {
    let (matrix, bias) = (trees.matrix(), trees.bias());
    let expressions = traced(matrix, Function::ForwardDynamics, |t, x| {
        let forces = denoc::bias_forces(bias, t, x[0], x[1]);
        let drive: Vec<Symbol> = x[2].iter().zip(forces).map(|(&tau, force)| tau - force).collect();
        Factorisation::new(matrix, t, &denoc::mass_matrix(matrix, t, x[0])).solve(&drive)
    });
    Ok(Way::measured(Method::Factorisation, simplified(expressions, passes)?, trees.reference()))
}

impl Way {
    fn measured(method: Method, expressions: Expressions, reference: &Reference) -> Self {
        let losses = reference.losses_by(Function::ForwardDynamics, |x| expressions.evaluate(x));
        Way { method, expressions, losses }
    }

    fn flops(&self) -> u32 {
        self.expressions.count().flops()
    }

    fn described(&self, kind: usize) -> Described {
        Described { method: self.method, flops: self.flops(), lost: self.losses[kind] }
    }
}

impl Described {
    fn name(&self) -> &'static str {
        match self.method {
            Method::Factorisation => "factorisation M = U D Uᵀ of the generalised inertia matrix (CRBA)",
            Method::Recursion => "O(n) recursion over articulated bodies (ABA)",
        }
    }
}

impl std::fmt::Display for Chosen {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Chosen { taken, other, .. } = self;
        write!(f, "By the {}: {} flops, errors of {:.0e}", taken.name(), taken.flops, taken.lost)?;
        match other {
            Some(other) => write!(f, "; the {} takes {}, errors of {:.0e}.", other.name(), other.flops, other.lost)?,
            None => write!(
                f,
                "; the explicit mass matrix is not considered for chains of more than {LONGEST_CHAIN_BY_FACTORISATION}."
            )?,
        }
        write!(f, " Errors are the largest √M_ii |Δa_i| at sampled states, as shares of the largest √M_jj |a_j|.")
    }
}
