//! The names that benches and examples give to processors.

#[allow(dead_code, reason = "a part of it is tested")]
#[path = "../../examples/common/processor.rs"]
mod processor;

use processor::name_in;

fn x86(vendor: &str, family: u32, model: u32, stepping: u32, brand: &str) -> String {
    let first = format!("vendor_id\t: {vendor}\ncpu family\t: {family}\nmodel\t\t: {model}\nmodel name\t: {brand}\n");
    // Another core, of another kind, comes after the first.
    format!("processor\t: 0\n{first}stepping\t: {stepping}\nflags\t\t: fpu\n\nprocessor\t: 1\nmodel\t\t: 0\n")
}

#[test]
fn a_name_is_the_plain_brand_with_the_microarchitecture() {
    let of = |vendor, family, model, stepping, brand| name_in(&x86(vendor, family, model, stepping, brand)).unwrap();
    let xeon = "Intel(R) Xeon(R) Processor @ 2.50GHz";
    assert_eq!(of("GenuineIntel", 6, 85, 4, xeon), "Intel Xeon (Skylake-SP)");
    assert_eq!(of("GenuineIntel", 6, 85, 7, xeon), "Intel Xeon (Cascade Lake)");
    assert_eq!(of("GenuineIntel", 6, 85, 11, xeon), "Intel Xeon (Cooper Lake)");
    assert_eq!(of("GenuineIntel", 6, 143, 8, xeon), "Intel Xeon (Sapphire Rapids)");
    assert_eq!(of("AuthenticAMD", 26, 2, 1, "AMD EPYC"), "AMD EPYC (Zen 5)");
    assert_eq!(of("AuthenticAMD", 25, 0x11, 1, "AMD EPYC 9354 32-Core Processor"), "AMD EPYC 9354 (Zen 4)");
}

#[test]
fn a_virtual_machine_with_another_model_s_number_is_named_by_its_instructions() {
    let rocket_lake = x86("GenuineIntel", 6, 167, 1, "Intel(R) Xeon(R) Processor");
    assert_eq!(name_in(&rocket_lake).unwrap(), "Intel Xeon (Rocket Lake)");
    let with_matrices = rocket_lake.replace("flags\t\t: fpu", "flags\t\t: fpu amx_tile");
    assert_eq!(name_in(&with_matrices).unwrap(), "Intel Xeon (Sapphire Rapids or later)");
}

#[test]
fn aarch64_is_named_by_the_core_s_part() {
    assert_eq!(name_in("CPU implementer\t: 0x41\nCPU part\t: 0xd0c\n").unwrap(), "Neoverse N1");
    assert_eq!(name_in("CPU implementer\t: 0x61\nCPU part\t: 0x022\n").unwrap(), "Apple M1");
}

#[test]
fn an_unknown_microarchitecture_leaves_the_brand_and_no_text_leaves_no_name() {
    assert_eq!(name_in(&x86("GenuineIntel", 6, 9999, 0, "Intel(R) New(TM) CPU")).unwrap(), "Intel New");
    assert_eq!(name_in("CPU implementer\t: 0x41\nCPU part\t: 0xfff\n"), None);
    assert_eq!(name_in(""), None);
}
