//! Where an example finds the workspace, and writes its files.

use std::path::{Path, PathBuf};

use super::csv::Csv;
use super::figure::Figure;
use super::table::headline;
use super::{Context, Failure, plot};

/// The folder of the workspace: the nearest one above the package of the example that has a lock file.
pub fn workspace() -> &'static Path {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    package.ancestors().find(|folder| folder.join("Cargo.lock").is_file()).unwrap_or(package)
}

/// The files of one example, in a folder of their own.
pub struct Outputs {
    folder: PathBuf,
    written: Vec<(String, &'static str)>,
}

impl Outputs {
    /// The folder `redysim/<example>` in Cargo's target directory, made if it is missing.
    pub fn of(example: &str) -> Result<Self, Failure> {
        let target = std::env::var_os("CARGO_TARGET_DIR").map(PathBuf::from);
        let target = target.unwrap_or_else(|| workspace().join("target"));
        let folder = target.join("redysim").join(example);
        std::fs::create_dir_all(&folder).context(|| {
            format!("cannot make the folder {}; set CARGO_TARGET_DIR to one that can be written", folder.display())
        })?;
        Ok(Outputs { folder, written: Vec::new() })
    }

    /// Writes a picture to `<name>.svg`.
    pub fn picture(&mut self, name: &str, what: &'static str, figure: &Figure) -> Result<(), Failure> {
        self.write(format!("{name}.svg"), what, &plot::svg(figure)?)
    }

    /// Writes numbers to `<name>.csv`.
    pub fn numbers(&mut self, name: &str, what: &'static str, csv: &Csv) -> Result<(), Failure> {
        self.write(format!("{name}.csv"), what, csv.text())
    }

    fn write(&mut self, name: String, what: &'static str, text: &str) -> Result<(), Failure> {
        let path = self.folder.join(&name);
        std::fs::write(&path, text)
            .context(|| format!("cannot write {}; is the disk full, or the file protected?", path.display()))?;
        self.written.push((name, what));
        Ok(())
    }

    /// Prints what was written and where.
    pub fn print(&self) {
        headline(&format!("Written to {}", self.shown().display()));
        let width = self.written.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
        for (name, what) in &self.written {
            println!("  {name:<width$}   {what}");
        }
        println!();
    }

    /// The folder, relative to the working directory if it is within.
    fn shown(&self) -> &Path {
        let here = std::env::current_dir().unwrap_or_default();
        self.folder.strip_prefix(here).unwrap_or(&self.folder)
    }
}
