//! `redysim generate --fmu`: a functional mock-up unit, the archive of its description, its sources and compiled code.

use std::env::{self, consts};
use std::fs;
use std::io::{self, Cursor, Write};
use std::path::Path;
use std::process::{Command, Stdio};

use super::{Arguments, Fmi, check_folder, failure, folder, load, report};
use crate::c_compiler::c_compiler;
use crate::failure::Failure;
use crate::output::{check_beside, to_stderr, write_together};
use redysim_codegen::{FmiVersion, FmuFiles, fmu_files};
use redysim_model::Loaded;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

/// Options of the compiler: the C of a program that is shared, and nothing of it visible but the functions of FMI.
const FLAGS: [&str; 5] = ["-std=c99", "-O2", "-fPIC", "-fvisibility=hidden", "-shared"];

/// Writes the FMU.
pub fn run(arguments: &Arguments, quiet: bool) -> Result<(), Failure> {
    let folder = folder(arguments, "--fmu")?;
    let version = match arguments.fmi {
        Fmi::V2 => FmiVersion::V2,
        Fmi::V3 => FmiVersion::V3,
    };
    let Loaded { model, options, .. } = load(arguments, quiet)?;
    let files = fmu_files(&model, arguments.name.clone(), version, &options).map_err(failure)?;
    let path = folder.join(format!("{}.fmu", files.prefix));
    check_folder(folder)?;
    check_beside(&arguments.model, &path, arguments.force)?;
    let compiled = if arguments.source_only { None } else { Some(compiled(&files, version)?) };
    let entries = files.files.iter().map(|(path, text)| (path.clone(), text.as_bytes()));
    let entries = entries.chain(compiled.iter().map(|(path, code)| (path.clone(), code.as_slice())));
    let archive = archive(entries).map_err(|error| Failure::file("make the archive", &path, &error))?;
    write_together(folder, &[(path.clone(), &archive)], arguments.force)?;
    if !quiet {
        files.sources().for_each(|(name, text)| {
            if name == format!("{}.c", files.prefix) {
                report(text)
            }
        });
        let code = compiled.map_or("sources alone".into(), |(path, _)| path);
        to_stderr(&format!("\n{} is an FMU of FMI {} with {code}", path.display(), version.name()));
    }
    Ok(())
}

/// An archive whose bytes depend on its entries alone.
fn archive<'a>(entries: impl Iterator<Item = (String, &'a [u8])>) -> io::Result<Vec<u8>> {
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .last_modified_time(DateTime::default());
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    for (path, contents) in entries {
        // Libraries are loaded from where they are unpacked.
        let permissions = if path.starts_with("binaries/") { 0o755 } else { 0o644 };
        archive.start_file(path, options.unix_permissions(permissions))?;
        archive.write_all(contents)?;
    }
    Ok(archive.finish()?.into_inner())
}

/// The place of compiled code for this platform in the archive, and the code.
fn compiled(files: &FmuFiles, version: FmiVersion) -> Result<(String, Vec<u8>), Failure> {
    let without = "write an FMU of sources alone with --source-only";
    let platform = platform(version).ok_or_else(|| {
        let message = format!("FMI {} has no name for {} on {}", version.name(), consts::OS, consts::ARCH);
        Failure::input(message).help(without)
    })?;
    let outside = |error: &io::Error, folder: &Path| Failure::file("compile in the folder", folder, error);
    let folder = tempfile::tempdir().map_err(|error| outside(&error, &env::temp_dir()))?;
    for (name, text) in files.sources() {
        fs::write(folder.path().join(name), text).map_err(|error| outside(&error, folder.path()))?;
    }
    let library = format!("{}{}", files.prefix, consts::DLL_SUFFIX);
    let (compiler, flags) = c_compiler();
    let mut command = Command::new(&compiler);
    command
        .args(flags)
        .args(FLAGS)
        .args(["-o", &library])
        .args([format!("{}.c", files.prefix), format!("{}_fmu.c", files.prefix)]);
    let output = command.arg("-lm").current_dir(folder.path()).stdin(Stdio::null()).output().map_err(|error| {
        let message = format!("the C compiler `{}` cannot be run: {error}", compiler.display());
        Failure::outside(message).help(format!("install one, name another one by CC, or {without}"))
    })?;
    if !output.status.success() {
        let text = String::from_utf8_lossy(&output.stderr);
        let first = text.lines().find(|line| line.contains("error")).or(text.lines().next()).unwrap_or_default();
        let message = format!("the C compiler `{}` fails ({}): {first}", compiler.display(), output.status);
        return Err(Failure::outside(message).help(format!("name another one by CC, or {without}")));
    }
    let code = fs::read(folder.path().join(&library)).map_err(|error| outside(&error, folder.path()))?;
    Ok((format!("binaries/{platform}/{library}"), code))
}

/// The name of this platform in an FMU.
fn platform(version: FmiVersion) -> Option<&'static str> {
    Some(match (version, consts::OS, consts::ARCH) {
        (FmiVersion::V3, "linux", "x86_64") => "x86_64-linux",
        (FmiVersion::V3, "linux", "aarch64") => "aarch64-linux",
        (FmiVersion::V3, "macos", "x86_64") => "x86_64-darwin",
        (FmiVersion::V3, "macos", "aarch64") => "aarch64-darwin",
        (FmiVersion::V3, "windows", "x86_64") => "x86_64-windows",
        (FmiVersion::V2, "linux", "x86_64") => "linux64",
        (FmiVersion::V2, "macos", _) => "darwin64",
        (FmiVersion::V2, "windows", "x86_64") => "win64",
        _ => return None,
    })
}
