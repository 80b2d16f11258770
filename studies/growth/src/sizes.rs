//! How much machine code the functions of a program take.

use object::{Object, ObjectSection, ObjectSymbol, SymbolKind};
use std::path::Path;

/// Bytes of machine code.
pub struct Sizes {
    /// Of the functions whose names have `inverse_dynamics`, `forward_dynamics`, `mass_matrix` in them.
    pub functions: [u64; 3],
    /// Of the whole program.
    pub text: u64,
}

/// The sizes of a program.
pub fn of(program: &Path) -> Sizes {
    let bytes = std::fs::read(program).expect("a program that was just built");
    let file = object::File::parse(&*bytes).expect("a program");
    let functions = ["inverse_dynamics", "forward_dynamics", "mass_matrix"].map(|name| {
        let of_that_name = |symbol: &object::Symbol| {
            symbol.kind() == SymbolKind::Text && symbol.name().is_ok_and(|symbol| symbol.contains(name))
        };
        // Identical functions may be one, under two names.
        let mut places: Vec<(u64, u64)> =
            file.symbols().filter(of_that_name).map(|symbol| (symbol.address(), symbol.size())).collect();
        places.sort_unstable();
        places.dedup_by_key(|(address, _)| *address);
        places.into_iter().map(|(_, size)| size).sum()
    });
    let text = file.section_by_name(".text").or_else(|| file.section_by_name("__text"));
    Sizes { functions, text: text.map_or(0, |section| section.size()) }
}
