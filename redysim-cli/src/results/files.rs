//! The folder of a run with its tables, written row by row.

use std::fs::File;
use std::path::PathBuf;

use super::record::Sink;
use super::tables::{Format, Quantities, Row};
use super::{Arguments, Ended, Folder, Summary, leftover, names, run_file, touch_down};
use crate::failure::Failure;
use crate::output::{to_stderr, to_stdout};
use crate::scenario::{Dynamics, Scenario};
use crate::table::write_row;

/// The files of a run, as far as they are written.
pub struct Files {
    folder: Folder,
    tables: Vec<(Quantities, csv::Writer<File>)>,
    format: Format,
    rows: usize,
}

/// Numbers on their way to a file are gathered until there are so many bytes.
const BUFFER: usize = 1 << 16;

impl Files {
    /// Begins the folder of a run. It is made before anything is computed, so that what cannot be written is reported at
    /// once.
    ///
    /// # Errors
    /// If it cannot be made, or if something is there already that must not be replaced.
    pub fn begin(
        arguments: &Arguments,
        scenario: &Scenario,
        dynamics: Dynamics,
        quiet: bool,
    ) -> Result<Files, Failure> {
        let target: PathBuf = arguments.folder(scenario, dynamics);
        if !quiet {
            leftover::warnings(&target).iter().for_each(|warning| to_stderr(warning));
        }
        let folder = Folder::draft(target, arguments.force)?;
        let (ending, delimiter) = match arguments.format {
            Format::Csv => ("csv", b','),
            Format::Dat => ("dat", b' '),
        };
        let begun = Quantities::of(scenario, dynamics, arguments.format).into_iter().map(|table| {
            let file = folder.create(&format!("{}.{ending}", table.name))?;
            let mut writer = csv::WriterBuilder::new().delimiter(delimiter).buffer_capacity(BUFFER).from_writer(file);
            if arguments.format == Format::Csv {
                writer.write_record(&table.headers).map_err(|error| unwritten(&table, error))?;
            }
            Ok((table, writer))
        });
        let tables = begun.collect::<Result<_, Failure>>()?;
        Ok(Files { folder, tables, format: arguments.format, rows: 0 })
    }

    /// Completes the folder, reports how the run went, and fails if it did not come to its end.
    ///
    /// # Errors
    /// If a file cannot be written, and why the run ended before its end, with where its rows are.
    pub fn finish(self, scenario: &Scenario, summary: Summary, quiet: bool) -> Result<(), Failure> {
        for (table, writer) in self.tables {
            let file = writer.into_inner().map_err(|error| unwritten(&table, error.into_error()))?;
            file.sync_all().map_err(|error| unwritten(&table, error))?;
        }
        // A table has rows, and ReDySim has no such file.
        let touch_downs = summary.outcome.contacts.as_ref().map(|(_, touch_downs)| touch_downs);
        if let Some(touch_downs) = touch_downs.filter(|list| self.format == Format::Csv && !list.is_empty()) {
            self.folder.write(&names::csv(names::TOUCH_DOWNS), &touch_down::to_csv(touch_downs)?)?;
        }
        run_file::write(&self.folder, scenario, &summary)?;
        let complete = matches!(summary.outcome.ended, Ended::Complete);
        let target = self.folder.finish(complete)?;
        if !quiet {
            to_stdout(&format!("{summary}\n  written to {}", target.display()));
        }
        let (_, until, count) = summary.instants;
        let kept = format!("{count} instants, until {until:?} s, are in {}", target.display());
        match summary.outcome.ended {
            Ended::Complete => Ok(()),
            Ended::Interrupted => Err(Failure::interrupted(kept)),
            Ended::Failed(reason) => Err(reason.and(&format!("; what was computed before is kept: {kept}"))),
        }
    }
}

impl Sink for Files {
    fn rows(&self, row: &Row<'_>) -> Result<Vec<Vec<f64>>, Failure> {
        self.tables.iter().map(|(table, _)| table.row(row, self.rows)).collect()
    }

    fn keep(&mut self, rows: Vec<Vec<f64>>) -> Result<(), Failure> {
        for ((table, writer), row) in self.tables.iter_mut().zip(&rows) {
            write_row(writer, row).map_err(|error| unwritten(table, error))?;
        }
        self.rows += 1;
        Ok(())
    }
}

fn unwritten(table: &Quantities, error: impl Into<csv::Error>) -> Failure {
    // As it came from the system: the way back by `From` keeps its text alone.
    let error = match error.into().into_kind() {
        csv::ErrorKind::Io(error) => error,
        other => std::io::Error::other(format!("{other:?}")),
    };
    Failure::file("write the table", table.name.as_ref(), &error)
}
