//! The processor that a program runs on, and the instructions that it is compiled for: what a time belongs to.

use std::collections::HashMap;
use std::fs;

/// The microarchitectures; `peers/driver/processor.py` reads the same table.
const TABLE: &str = include_str!("processors.csv");

/// One line, such as `Intel Xeon (Cascade Lake), has avx2, fma, avx512f; compiled for avx2, fma`.
pub fn described() -> String {
    let (present, compiled) = (present(), compiled());
    let has = if present.is_empty() { String::new() } else { format!(", has {}", present.join(", ")) };
    let architecture = std::env::consts::ARCH.replace('_', "-");
    let target = if compiled.is_empty() { format!("any {architecture}") } else { compiled.join(", ") };
    format!("{}{has}; compiled for {target}", name())
}

/// The processor's name, with its microarchitecture where that is known.
pub fn name() -> String {
    let text = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    name_in(&text).unwrap_or_else(|| format!("unknown {} processor", std::env::consts::ARCH))
}

/// The name by the text of `/proc/cpuinfo`.
pub fn name_in(cpuinfo: &str) -> Option<String> {
    let mut fields: HashMap<&str, &str> = HashMap::new();
    for (key, value) in cpuinfo.lines().filter_map(|line| line.split_once(':')) {
        // The first core's count.
        fields.entry(key.trim()).or_insert(value.trim());
    }
    let brand = fields.get("model name").map(|brand| plain(brand)).filter(|brand| !brand.is_empty());
    match (brand, microarchitecture(&fields)) {
        (Some(brand), Some(kind)) => Some(format!("{brand} ({kind})")),
        (brand, kind) => brand.or(kind.map(str::to_owned)),
    }
}

fn microarchitecture(fields: &HashMap<&str, &str>) -> Option<&'static str> {
    let field = |x86, arm| fields.get(x86).or_else(|| fields.get(arm)).copied();
    let vendor = field("vendor_id", "CPU implementer")?;
    let numbers = [field("cpu family", ""), field("model", "CPU part"), field("stepping", "")];
    let has = |flag: &str| fields.get("flags").is_some_and(|flags| flags.split(' ').any(|found| found == flag));
    TABLE.lines().filter(|line| !line.starts_with('#')).find_map(|line| {
        let cells: Vec<&str> = line.split(',').collect();
        let [maker, ranges @ .., flag, name] = cells.as_slice() else { return None };
        let fits = *maker == vendor && ranges.iter().zip(numbers).all(|(range, text)| covers(range, text));
        (fits && (flag.is_empty() || has(flag))).then_some(*name)
    })
}

/// Whether a range of the table has the number in it.
fn covers(range: &str, text: Option<&str>) -> bool {
    let (first, last) = range.split_once('-').unwrap_or((range, range));
    match (number(first), number(last), text.and_then(number)) {
        (Some(first), Some(last), Some(found)) => (first..=last).contains(&found),
        _ => range.is_empty(),
    }
}

fn number(text: &str) -> Option<u32> {
    match text.strip_prefix("0x") {
        Some(digits) => u32::from_str_radix(digits, 16).ok(),
        None => text.parse().ok(),
    }
}

/// A brand without trade marks, clock, number of cores and words that every brand has.
fn plain(brand: &str) -> String {
    let brand = brand.replace("(R)", "").replace("(TM)", "").replace("(tm)", "");
    let kept = brand.split(" @ ").next().unwrap_or_default().split(" with ").next().unwrap_or_default();
    let common = |word: &&str| !["CPU", "Processor"].contains(word) && !word.ends_with("-Core");
    kept.split_whitespace().filter(common).collect::<Vec<_>>().join(" ")
}

/// The vector instructions that the processor and the operating system offer.
fn present() -> Vec<&'static str> {
    #[cfg(target_arch = "x86_64")]
    let known = [
        ("avx2", is_x86_feature_detected!("avx2")),
        ("fma", is_x86_feature_detected!("fma")),
        ("avx512f", is_x86_feature_detected!("avx512f")),
    ];
    #[cfg(not(target_arch = "x86_64"))]
    let known = [];
    those(known)
}

/// The vector instructions that the compiler was allowed to use.
fn compiled() -> Vec<&'static str> {
    those([
        ("avx2", cfg!(target_feature = "avx2")),
        ("fma", cfg!(target_feature = "fma")),
        ("avx512f", cfg!(target_feature = "avx512f")),
    ])
}

fn those<const N: usize>(known: [(&'static str, bool); N]) -> Vec<&'static str> {
    known.into_iter().filter_map(|(name, is_there)| is_there.then_some(name)).collect()
}
