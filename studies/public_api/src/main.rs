//! Prints the public items that a file of rustdoc's JSON describes, one in a line: `public-api-study FILE`.

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
    for item in api.items() {
        writeln!(output, "{item}")?;
    }
    Ok(())
}
