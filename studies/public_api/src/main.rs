//! Prints the public items that a file of rustdoc's JSON describes, one in a line: `public-api-study FILE`. Fails if an
//! item of a module has two paths.

use std::collections::{HashMap, HashSet};
use std::io::Write;
use std::path::Path;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let file = std::env::args().nth(1).ok_or("usage: public-api-study FILE")?;
    let api = public_api::Builder::from_rustdoc_json(Path::new(&file))
        .omit_blanket_impls(true)
        .omit_auto_trait_impls(true)
        .omit_auto_derived_impls(true)
        .build()?;
    let mut output = std::io::stdout().lock();
    let (mut modules, mut paths, mut twice) = (HashSet::new(), HashMap::new(), 0);
    for item in api.items() {
        let line = item.to_string();
        writeln!(output, "{line}")?;
        if line.starts_with("pub mod ") {
            modules.insert(item.id());
        }
        // Provided methods of a trait have a line for each type that implements it.
        if item.parent_id().is_none_or(|parent| !modules.contains(&parent)) {
            continue;
        }
        if let Some(first) = paths.insert(item.id(), line.clone()) {
            eprintln!("an item has two paths:\n    {first}\n    {line}");
            twice += 1;
        }
    }
    if twice == 0 { Ok(()) } else { Err(format!("{twice} items have two paths").into()) }
}
