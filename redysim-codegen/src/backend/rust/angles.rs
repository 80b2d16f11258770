//! Angles as Rust expressions of the coordinates.

use super::body::local;
use super::values::constant;
use crate::angles::{Angle, Term};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;

/// The name of a coordinate without whole turns.
pub fn without_turns(coordinate: u32) -> Ident {
    local(&format!("near_{coordinate}"))
}

/// An angle as an expression of the coordinates. In sums, coordinates are read [without whole turns](without_turns).
pub fn angle(angle: &Angle) -> TokenStream {
    let Angle { terms, constant: offset } = angle;
    let mut sum = TokenStream::new();
    for (place, Term { coordinate, factor, without_turns: near }) in terms.iter().enumerate() {
        let value = if *near {
            let near = without_turns(*coordinate);
            quote!(#near)
        } else {
            let (q, index) = (local("q"), Literal::u32_unsuffixed(*coordinate));
            quote!(#q[#index])
        };
        let factor_of_value = (factor.abs() != 1.0).then(|| {
            let factor = constant(factor.abs());
            quote!(S::from_f64(#factor) *)
        });
        let sign = match (place, *factor < 0.0) {
            (0, false) => None,
            (_, false) => Some(quote!(+)),
            (_, true) => Some(quote!(-)),
        };
        sum.extend(quote!(#sign #factor_of_value #value));
    }
    if *offset != 0.0 {
        let (sign, size) = (if *offset < 0.0 { quote!(-) } else { quote!(+) }, constant(offset.abs()));
        sum.extend(quote!(#sign S::from_f64(#size)));
    }
    sum
}
