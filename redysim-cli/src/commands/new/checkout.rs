//! How a crate depends on redysim.

use std::fs;
use std::path::Path;

use crate::failure::Failure;
use crate::output::to_stderr;

/// The dependency as a manifest has it: by the path of `given`, else of the checkout `built_from`, else
/// by its version.
///
/// # Errors
/// If `given` is not a checkout of redysim.
pub fn dependency(given: Option<&Path>, built_from: Option<&Path>, quiet: bool) -> Result<String, Failure> {
    let own = built_from.filter(|folder| is_checkout(folder));
    match (given, own) {
        (Some(folder), _) if !is_checkout(folder) => {
            let message = format!("{} is not a checkout of redysim", folder.display());
            Err(Failure::command_line(message)
                .help("--redysim takes the folder with the Cargo.toml of the crate `redysim`"))
        }
        (Some(folder), _) | (None, Some(folder)) => {
            let folder = fs::canonicalize(folder).map_err(|error| Failure::file("read the folder", folder, &error))?;
            let path = toml::Value::String(folder.display().to_string());
            Ok(format!("{{ path = {path} }}"))
        }
        (None, None) => {
            if !quiet {
                to_stderr(
                    "warning: the checkout that this command is built from is gone: the crate depends on the published \
                     version\n  = help: name another checkout with --redysim",
                );
            }
            Ok(format!("\"{}\"", env!("CARGO_PKG_VERSION")))
        }
    }
}

/// Whether the folder has the crate `redysim`.
fn is_checkout(folder: &Path) -> bool {
    let manifest = fs::read_to_string(folder.join("Cargo.toml")).unwrap_or_default();
    let manifest: toml::Table = manifest.parse().unwrap_or_default();
    let name = manifest.get("package").and_then(|package| package.get("name"));
    name.and_then(toml::Value::as_str) == Some("redysim")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_a_checkout_a_crate_depends_on_the_version_of_the_command() {
        let gone = Path::new("/nowhere/redysim");
        assert_eq!(dependency(None, Some(gone), true).unwrap(), format!("\"{}\"", env!("CARGO_PKG_VERSION")));
        assert!(dependency(Some(gone), None, true).is_err());
    }
}
