//! The rows of a study in parts of Parquet, beside the table in CSV from which a study continues.

use std::collections::HashSet;
use std::fs::{self, File};
use std::io;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use csv::{ReaderBuilder, StringRecord};
use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::column::reader::ColumnReader;
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;

use super::Study;
use crate::failure::Failure;
use crate::output::{make_folder, write_file};

/// The folder of the parts in that of a study.
const FOLDER: &str = "rows";

/// Parts of so many rows, each written when its rows are there.
pub struct Parts {
    folder: PathBuf,
    size: NonZeroUsize,
    schema: Arc<Type>,
    /// The samples whose rows are in a part.
    kept: HashSet<usize>,
    /// The rows that are in no part.
    waiting: Vec<(usize, StringRecord)>,
}

impl Parts {
    /// Those of the study in `folder`, with parts for the rows of `table` that are in none.
    ///
    /// # Errors
    /// If a part cannot be read or written.
    pub fn open(folder: &Path, study: &Study, size: NonZeroUsize, table: &str) -> Result<Parts, Failure> {
        let folder = folder.join(FOLDER);
        make_folder(&folder)?;
        let mut kept = HashSet::new();
        for part in parts(&folder)? {
            let samples = read_samples(&part).map_err(|error| {
                let message = format!("cannot read {}: {error}", part.display());
                Failure::outside(message).help("delete it: its rows are written again")
            })?;
            kept.extend(samples);
        }
        let mut parts = Parts { folder, size, schema: schema(study), kept, waiting: Vec::new() };
        table.lines().skip(1).try_for_each(|row| parts.add(row))?;
        Ok(parts)
    }

    /// Takes a row, and writes a part if enough of them wait.
    ///
    /// # Errors
    /// If the part cannot be written.
    pub fn add(&mut self, row: &str) -> Result<(), Failure> {
        let record = ReaderBuilder::new().has_headers(false).from_reader(row.as_bytes()).into_records().next();
        let Some(Ok(record)) = record else { return Ok(()) };
        let Some(sample) = record.get(0).and_then(|cell| cell.parse().ok()) else { return Ok(()) };
        if self.kept.insert(sample) {
            self.waiting.push((sample, record));
        }
        if self.waiting.len() >= self.size.get() { self.finish() } else { Ok(()) }
    }

    /// Writes a part of the rows that wait.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn finish(&mut self) -> Result<(), Failure> {
        let Some((first, _)) = self.waiting.first() else { return Ok(()) };
        let path = self.folder.join(format!("part-{first:08}.parquet"));
        let part = encode(&self.schema, &self.waiting)
            .map_err(|error| Failure::outside(format!("cannot write {}: {error}", path.display())))?;
        write_file(&path, &part, true)?;
        self.waiting.clear();
        Ok(())
    }
}

/// Deletes the parts of a study that is replaced.
///
/// # Errors
/// If one cannot be deleted.
pub fn remove(folder: &Path) -> Result<(), Failure> {
    for part in parts(&folder.join(FOLDER))? {
        fs::remove_file(&part).map_err(|error| Failure::file("delete", &part, &error))?;
    }
    Ok(())
}

/// The files of the parts in a folder; none if it does not exist.
fn parts(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let entries = match fs::read_dir(folder) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
        entries => entries.and_then(Iterator::collect::<Result<Vec<_>, _>>),
    };
    let entries = entries.map_err(|error| Failure::file("read", folder, &error))?;
    let is_part = |name: &str| name.starts_with("part-") && name.ends_with(".parquet");
    let parts = entries.iter().filter(|entry| entry.file_name().to_str().is_some_and(is_part));
    Ok(parts.map(fs::DirEntry::path).collect())
}

/// The columns of a study: numbers, which a failed sample does not have, and texts.
fn schema(study: &Study) -> Arc<Type> {
    let column = |(index, (name, is_numeric)): (usize, (&String, bool))| {
        let (physical, repetition, logical) = match (index, is_numeric) {
            (0, _) => (Physical::INT64, Repetition::REQUIRED, None),
            (_, true) => (Physical::DOUBLE, Repetition::OPTIONAL, None),
            (_, false) => (Physical::BYTE_ARRAY, Repetition::REQUIRED, Some(LogicalType::String)),
        };
        let column = Type::primitive_type_builder(name, physical).with_repetition(repetition);
        Arc::new(column.with_logical_type(logical).build().expect("the types are compatible"))
    };
    let columns = study.headers().iter().zip(study.numeric()).enumerate().map(column).collect();
    Arc::new(Type::group_type_builder("rows").with_fields(columns).build().expect("a group of columns"))
}

/// A file of Parquet.
fn encode(schema: &Arc<Type>, rows: &[(usize, StringRecord)]) -> Result<Vec<u8>, ParquetError> {
    let mut writer = SerializedFileWriter::new(Vec::new(), schema.clone(), Arc::new(WriterProperties::default()))?;
    let mut group = writer.next_row_group()?;
    for (index, column) in schema.get_fields().iter().enumerate() {
        let cells = rows.iter().map(|(_, record)| record.get(index).unwrap_or_default());
        let Some(mut writer) = group.next_column()? else { break };
        match column.get_physical_type() {
            Physical::INT64 => {
                let samples: Vec<i64> = rows.iter().map(|(sample, _)| *sample as i64).collect();
                writer.typed::<Int64Type>().write_batch(&samples, None, None)?;
            }
            Physical::DOUBLE => {
                let numbers: Vec<Option<f64>> = cells.map(|cell| cell.parse().ok()).collect();
                let is_there: Vec<i16> = numbers.iter().map(|number| number.is_some().into()).collect();
                let numbers: Vec<f64> = numbers.into_iter().flatten().collect();
                writer.typed::<DoubleType>().write_batch(&numbers, Some(&is_there), None)?;
            }
            _ => {
                let texts: Vec<ByteArray> = cells.map(ByteArray::from).collect();
                writer.typed::<ByteArrayType>().write_batch(&texts, None, None)?;
            }
        }
        writer.close()?;
    }
    group.close()?;
    writer.into_inner()
}

/// The samples whose rows are in a part.
fn read_samples(part: &Path) -> Result<Vec<usize>, ParquetError> {
    let reader = SerializedFileReader::new(File::open(part)?)?;
    let mut samples = Vec::new();
    for index in 0..reader.num_row_groups() {
        let group = reader.get_row_group(index)?;
        let rows = group.metadata().num_rows() as usize;
        match group.get_column_reader(0)? {
            ColumnReader::Int64ColumnReader(mut column) => column.read_records(rows, None, None, &mut samples)?,
            _ => return Err(ParquetError::General("its first column is not that of the samples".to_owned())),
        };
    }
    Ok(samples.into_iter().filter_map(|sample| sample.try_into().ok()).collect())
}
