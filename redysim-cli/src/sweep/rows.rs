//! The folder of a study: its definition, and the rows of its samples, each written as it comes.

use std::fs::{self, File, OpenOptions};
use std::io::{Read, Seek, SeekFrom, Write};
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

use super::parts::{self, Parts};
use super::{COMPLETE, Study, sampler};
use crate::failure::Failure;
use crate::output::{exists, make_folder, write_file};

/// The study, with all that it takes to go on with it.
const STUDY: &str = "study.json";
/// The rows.
const ROWS: &str = "rows.csv";

/// Whether a folder has the rows of a study.
pub fn is_of_rows(folder: &Path) -> bool {
    folder.join(STUDY).exists()
}

/// The rows of a [`Study`] in its folder, which are written as they come. Another process cannot open them meanwhile.
pub struct Rows {
    path: PathBuf,
    file: File,
    /// Bytes of whole rows.
    length: u64,
    /// For each sample whether its row is there.
    done: Vec<bool>,
    /// Whether the rows are in the order of the samples.
    in_order: bool,
    last: Option<usize>,
    parts: Option<Parts>,
}

impl Rows {
    /// Opens the folder of a study, and creates it if it does not exist. If it holds the same study, with as many samples or
    /// fewer, that study continues; with `force`, a different study is replaced.
    ///
    /// # Errors
    /// If something else is there, or it cannot be read or written.
    pub fn open(folder: impl AsRef<Path>, study: &Study, force: bool) -> Result<Rows, Failure> {
        let folder = folder.as_ref();
        let begun = begun(folder, study, force)?;
        make_folder(folder)?;
        let path = folder.join(ROWS);
        let failed = |doing: &str, error| Failure::file(doing, &path, &error);
        let open = OpenOptions::new().create(true).truncate(false).read(true).write(true).open(&path);
        let file = open.map_err(|error| failed("write", error))?;
        if file.try_lock().is_err() {
            let message = format!("{} is being written by another process", path.display());
            return Err(Failure::outside(message).help("wait until it ends, or write elsewhere with --output"));
        }
        let done = vec![false; study.samples.len()];
        let mut rows = Rows { file, length: 0, done, in_order: true, last: None, parts: None, path };
        if begun.is_none() {
            parts::remove(folder)?;
            rows.cut(0)?;
        }
        if begun.is_none_or(|samples| samples < study.samples.len()) {
            write_file(&folder.join(STUDY), study.to_json().as_bytes(), true)?;
        }
        rows.read(study)?;
        Ok(rows)
    }

    /// Writes parts in Parquet, too, each of `size` rows when these are there, to the folder `rows` beside the table. Rows
    /// that are in no part yet come first.
    ///
    /// # Errors
    /// If a part cannot be read or written.
    pub fn with_parts(mut self, study: &Study, size: NonZeroUsize) -> Result<Rows, Failure> {
        let table = self.text()?;
        let folder = self.path.parent().unwrap_or(Path::new(""));
        self.parts = Some(Parts::open(folder, study, size, &table)?);
        Ok(self)
    }

    /// The file of the rows.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The samples whose rows are missing.
    pub fn missing(&self) -> Vec<usize> {
        (0..self.done.len()).filter(|&index| !self.done[index]).collect()
    }

    /// How many rows there are.
    pub fn count(&self) -> usize {
        self.done.iter().filter(|done| **done).count()
    }

    /// How many rows there will be.
    pub fn total(&self) -> usize {
        self.done.len()
    }

    /// Writes the row of the sample `index`, a line without its end.
    ///
    /// # Errors
    /// If it cannot be written. The rows that were written are kept.
    pub fn add(&mut self, index: usize, row: &str) -> Result<(), Failure> {
        self.write(row)?;
        self.note(index);
        let written = self.parts.as_mut().map_or(Ok(()), |parts| parts.add(row));
        written.map_err(|failure| self.kept(failure))
    }

    /// Has all rows on the disk, in the order of the samples.
    ///
    /// # Errors
    /// If they cannot be written. They are kept in the order in which they came.
    pub fn finish(&mut self) -> Result<(), Failure> {
        let written = self.parts.as_mut().map_or(Ok(()), Parts::finish);
        written.map_err(|failure| self.kept(failure))?;
        if !self.in_order {
            let text = self.text()?;
            let mut lines = text.lines();
            let header = lines.next().unwrap_or_default();
            let mut rows: Vec<(usize, &str)> = lines.filter_map(|line| Some((index(line)?, line))).collect();
            rows.sort_by_key(|(index, _)| *index);
            rows.dedup_by_key(|(index, _)| *index);
            let sorted = rows.iter().fold(format!("{header}\n"), |text, (_, line)| text + line + "\n");
            write_file(&self.path, sorted.as_bytes(), true).map_err(|failure| self.kept(failure))?;
            self.in_order = true;
        }
        self.file.sync_all().map_err(|error| self.kept(Failure::file("write", &self.path, &error)))
    }

    /// How many samples failed, and the reason of the first.
    ///
    /// # Errors
    /// If the rows cannot be read.
    pub(crate) fn failures(&self) -> Result<(usize, Option<String>), Failure> {
        let text = fs::read_to_string(&self.path).map_err(|error| Failure::file("read", &self.path, &error))?;
        let records = csv::Reader::from_reader(text.as_bytes()).into_records();
        let mut failed = records.filter_map(Result::ok).filter_map(|record| {
            let (reason, status) = (record.len().checked_sub(1)?, record.len().checked_sub(2)?);
            let is_failed = record.get(status)? != COMPLETE;
            is_failed.then(|| format!("sample {}: {}", &record[0], &record[reason]))
        });
        let first = failed.next();
        Ok((usize::from(first.is_some()) + failed.count(), first))
    }

    fn write(&mut self, line: &str) -> Result<(), Failure> {
        let bytes = [line.as_bytes(), b"\n"].concat();
        if let Err(error) = self.file.write_all(&bytes) {
            // A part of the row may be there. If it stays, the next run takes it away.
            let _ = self.file.set_len(self.length);
            return Err(self.kept(Failure::file("write", &self.path, &error)));
        }
        self.length += bytes.len() as u64;
        Ok(())
    }

    fn kept(&self, failure: Failure) -> Failure {
        let (count, total) = (self.count(), self.total());
        let kept = format!("; {count} of {total} samples are kept in {}", self.path.display());
        failure.and(&kept).help("make room on the disk: the same command then goes on with the rest")
    }

    fn note(&mut self, index: usize) {
        self.done[index] = true;
        self.in_order &= self.last.is_none_or(|last| last < index);
        self.last = Some(index);
    }

    fn text(&mut self) -> Result<String, Failure> {
        let mut bytes = Vec::new();
        let read = self.file.seek(SeekFrom::Start(0)).and_then(|_| self.file.read_to_end(&mut bytes));
        read.map_err(|error| Failure::file("read", &self.path, &error))?;
        String::from_utf8(bytes).map_err(|_| self.foreign(1))
    }

    /// Reads the rows that are there. The last one may be torn, for the program may have been ended while it wrote it.
    fn read(&mut self, study: &Study) -> Result<(), Failure> {
        let text = self.text()?;
        let whole = text.rfind('\n').map_or(0, |end| end + 1);
        self.cut(whole as u64)?;
        let header = sampler::line(&study.headers());
        let mut lines = text[..whole].lines();
        match lines.next() {
            None => self.write(&header)?,
            Some(first) if first == header => {}
            Some(_) => return Err(self.foreign(1)),
        }
        for (k, line) in lines.enumerate() {
            let index = index(line).filter(|index| *index < self.done.len());
            self.note(index.ok_or_else(|| self.foreign(k + 2))?);
        }
        Ok(())
    }

    /// Takes away what is beyond so many bytes.
    fn cut(&mut self, length: u64) -> Result<(), Failure> {
        self.length = length;
        let cut = self.file.set_len(length).and_then(|()| self.file.seek(SeekFrom::Start(length)));
        cut.map(drop).map_err(|error| Failure::file("write", &self.path, &error))
    }

    fn foreign(&self, line: usize) -> Failure {
        let message = format!("{}:{line} is not a row of this study", self.path.display());
        Failure::outside(message).help(ELSEWHERE)
    }
}

const ELSEWHERE: &str = "write elsewhere with --output, or replace it with --force";

/// How many samples the study in a folder has so far with which `study` goes on; `None` if it begins anew.
fn begun(folder: &Path, study: &Study, force: bool) -> Result<Option<usize>, Failure> {
    let definition = folder.join(STUDY);
    let text = match fs::read_to_string(&definition) {
        Ok(text) => text,
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
            return Err(Failure::file("read", &definition, &error));
        }
        Err(_) if is_of_others(folder) => {
            return Err(exists(folder).and(", and is not the folder of a study").help("write elsewhere with --output"));
        }
        Err(_) => return Ok(None),
    };
    let message = match Study::from_json(&text) {
        Ok(begun) => match study.difference(&begun) {
            None => return Ok(Some(begun.samples.len())),
            Some(what) => format!("{} has rows of another study: {what} differed", folder.display()),
        },
        Err(_) => format!("{} is not a study of this version of redysim", definition.display()),
    };
    if force { Ok(None) } else { Err(Failure::outside(message).help(ELSEWHERE)) }
}

/// Whether a folder holds what no study has left. A full disk may have had room for a table without rows alone.
fn is_of_others(folder: &Path) -> bool {
    let is_empty_table =
        |entry: fs::DirEntry| entry.file_name() == ROWS && entry.metadata().is_ok_and(|file| file.len() == 0);
    fs::read_dir(folder).is_ok_and(|mut entries| !entries.all(|entry| entry.is_ok_and(is_empty_table)))
}

/// The sample of a row.
fn index(line: &str) -> Option<usize> {
    line.split(',').next()?.parse().ok()
}
