//! `redysim sweep STUDY`.

use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;
use std::thread;
use std::time::Instant;

use crate::failure::Failure;
use crate::interrupt;
use crate::number::{counted, rounded};
use crate::output::{to_stderr, to_stdout, write_together};
use crate::progress::Progress;
use crate::sweep::{Rows, Study, is_of_rows};

/// Run a scenario for many values of its initial state, its gains, the parameters of its model, on all cores.
///
/// Rows are written as they come. What was interrupted goes on with the same command.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  redysim sweep scenarios/studies/two_link_gains.toml")]
pub struct Arguments {
    /// The study file.
    study: PathBuf,
    /// The folder of the study [default: results/<study's name>/sweep].
    #[arg(long, short, value_name = "DIR")]
    output: Option<PathBuf>,
    /// The files of the rows. They are always in `rows.csv`.
    #[arg(long, value_enum, default_value_t, value_name = "FORMAT", conflicts_with = "sample")]
    format: Format,
    /// How many samples are computed at once [default: the number of cores].
    #[arg(long, short, value_name = "COUNT", value_parser = jobs)]
    jobs: Option<NonZeroUsize>,
    /// Replace another study that is there.
    #[arg(long)]
    force: bool,
    /// Write the scenario and the model of one sample, counted from 0, instead of computing rows.
    #[arg(long, value_name = "INDEX", conflicts_with = "jobs")]
    sample: Option<usize>,
}

#[derive(Clone, Copy, Default, PartialEq, clap::ValueEnum)]
enum Format {
    /// `rows.csv` alone
    #[default]
    Csv,
    /// Also the folder `rows` with a part for every thousand rows, which `pandas.read_parquet` reads as one table
    Parquet,
}

/// The number of jobs that `text` states.
fn jobs(text: &str) -> Result<NonZeroUsize, String> {
    text.parse().map_err(|_| "a whole number is needed, 1 or more".to_owned())
}

/// The rows of a part in Parquet.
const PART: NonZeroUsize = NonZeroUsize::new(1000).unwrap();

/// Computes the samples whose rows are missing, and writes them.
pub fn run(arguments: &Arguments, quiet: bool) -> Result<(), Failure> {
    let study = Study::load(&arguments.study)?;
    if !quiet {
        study.warnings().iter().for_each(|warning| to_stderr(&format!("{warning}\n")));
    }
    let usual = || PathBuf::from("results").join(study.name()).join("sweep");
    let folder = arguments.output.clone().unwrap_or_else(usual);
    if let Some(index) = arguments.sample {
        return write_sample(&study, index, &folder, (arguments.force, quiet));
    }
    let mut rows = Rows::open(&folder, &study, arguments.force)?;
    if arguments.format == Format::Parquet {
        rows = rows.with_parts(&study, PART)?;
    }
    let there = rows.count();
    if there > 0 && !quiet {
        to_stderr(&format!("{} of {} are there already", counted(there, "sample"), rows.total()));
    }
    interrupt::watch()?;
    let begun = Instant::now();
    let cores = thread::available_parallelism().unwrap_or(NonZeroUsize::MIN);
    compute(&study, &mut rows, arguments.jobs.unwrap_or(cores), quiet)?;
    rows.finish()?;
    let (count, total) = (rows.count(), rows.total());
    if count < total {
        let kept = format!("{count} of {total} samples are in {}; the same command goes on", rows.path().display());
        return Err(Failure::interrupted(kept));
    }
    if !quiet {
        let seconds = begun.elapsed().as_secs_f64();
        let computed = match total - there {
            0 => String::new(),
            new => format!(", {new} computed in {} s", rounded(seconds)),
        };
        to_stdout(&format!(
            "{}: {}{computed}\n  written to {}",
            study.name(),
            counted(total, "sample"),
            rows.path().display()
        ));
    }
    let (failed, first) = rows.failures()?;
    if let Some(first) = first.filter(|_| !quiet) {
        to_stderr(&format!("warning: {failed} of {total} failed, the first of them {first}"));
    }
    Ok(())
}

/// Computes what is missing on so many threads. What Ctrl-C ends is missing still.
fn compute(study: &Study, rows: &mut Rows, jobs: NonZeroUsize, quiet: bool) -> Result<(), Failure> {
    let missing = rows.missing();
    let next = AtomicUsize::new(0);
    let mut progress = Progress::new(missing.len(), quiet);
    let (done, computed) = mpsc::channel();
    thread::scope(|scope| {
        for _ in 0..jobs.get().min(missing.len()) {
            let (done, sampler, missing, next) = (done.clone(), study.sampler(), &missing, &next);
            scope.spawn(move || {
                while let Some(&index) = missing.get(next.fetch_add(1, Ordering::Relaxed)) {
                    if interrupt::asked() {
                        break;
                    }
                    let row = sampler.row(&study.sample(index));
                    // The rows that were sent are written before anything ends.
                    if row.is_none_or(|row| done.send((index, row)).is_err()) {
                        break;
                    }
                }
            });
        }
        drop(done);
        for (count, (index, row)) in computed.iter().enumerate() {
            rows.add(index, &row).inspect_err(|_| interrupt::ask())?;
            progress.reach(count + 1);
        }
        Ok(())
    })
}

/// Writes what `redysim forward` and `redysim inverse` take to run one sample alone.
fn write_sample(study: &Study, index: usize, folder: &Path, (force, quiet): (bool, bool)) -> Result<(), Failure> {
    if index >= study.count() {
        let failure = Failure::command_line(format!("the study has no sample {index}"));
        return Err(failure.help(format!("it has the samples 0 to {}", study.count() - 1)));
    }
    let files = study.sampler().to_run_alone(&study.sample(index))?;
    if is_of_rows(folder) {
        let failure = Failure::command_line(format!("{} is the folder of the rows of a study", folder.display()));
        return Err(failure.help("name another one with --output"));
    }
    let files: Vec<_> = files.iter().map(|(name, text)| (folder.join(name), text.as_bytes())).collect();
    write_together(folder, &files, force)?;
    if !quiet {
        to_stdout(&format!("written to {}; run {} there", folder.display(), study.sampler().run));
    }
    Ok(())
}
