//! What the code of every mechanism needs, kept as C: multiply-adds, sines and cosines, and the check of inertia tensors.

use super::scalar::{Abreast, CScalar};

const ARITHMETIC: &str = include_str!("runtime/arithmetic.c");
const VECTOR: &str = include_str!("runtime/vector.c");
const BRANCHES: &str = include_str!("runtime/branches.c");
const NUMBERS: &str = include_str!("runtime/numbers.c");
const BITS: &str = include_str!("runtime/bits.c");
const SIN_COS_F64: &str = include_str!("runtime/sin_cos_f64.c");
const KERNEL_F64: &str = include_str!("runtime/sin_cos_f64_kernel.c");
const SLOW_PATH_F64: &str = include_str!("runtime/sin_cos_f64_slow_path.c");
const SIN_COS_F32: &str = include_str!("runtime/sin_cos_f32.c");
const KERNEL_F32: &str = include_str!("runtime/sin_cos_f32_kernel.c");
const SLOW_PATH_F32: &str = include_str!("runtime/sin_cos_f32_slow_path.c");
const SIN_COS: &str = include_str!("runtime/sin_cos_of_angles.c");
const LIBRARY_SIN_COS: &str = include_str!("runtime/library_sin_cos.c");
const ONE_ANGLE: &str = include_str!("runtime/one_angle.c");
const TURNS: &str = include_str!("runtime/turns.c");
const PARAMETERS: &str = include_str!("runtime/parameters.c");
const LANES: &str = include_str!("runtime/lanes.c");
const LANES_SIN_COS: &str = include_str!("runtime/lanes_sin_cos.c");

/// Which parts the code of a mechanism needs.
#[derive(Clone, Debug, Default)]
pub struct Needed {
    /// Sines and cosines of several angles.
    pub angles: bool,
    /// The sine of one angle in an expression.
    pub sine: bool,
    /// The cosine of one angle in an expression.
    pub cosine: bool,
    /// Angles without whole turns.
    pub without_turns: bool,
    /// The numbers of branches that are computed at once, each once.
    pub abreast: Vec<Abreast>,
}

/// The parts before the functions.
pub fn parts(needed: Needed, scalar: CScalar) -> String {
    let mut text = of_scalar(ARITHMETIC, scalar);
    for abreast in needed.abreast {
        text += &format!("\n{}", branches(abreast, scalar));
    }
    if !(needed.angles || needed.sine || needed.cosine) {
        return text;
    }
    let (head, kernel, slow_path) = match scalar {
        CScalar::F64 => (SIN_COS_F64, KERNEL_F64, SLOW_PATH_F64),
        CScalar::F32 => (SIN_COS_F32, KERNEL_F32, SLOW_PATH_F32),
    };
    // The same code twice: over numbers and over vectors of them.
    let kernel = kernel_of(kernel, scalar);
    let group = format!("{}\n{}", vector("group", "REDYSIM_GROUP", 256, scalar), in_vectors(&kernel, scalar, "group"));
    let [kind, suffix] = suffix_on_x86(scalar);
    let x86 = [128, 256].map(|width| format!("__m{width}{kind}"));
    let (any, none) = (format!("_mm_movemask_{suffix}"), format!("_mm256_testz_{suffix}"));
    let names =
        [("group_type", &group), ("x86_128", &x86[0]), ("x86_256", &x86[1]), ("any_128", &any), ("none_256", &none)];
    let angles = of_scalar(&filled(SIN_COS, &names.map(|(name, value)| (name, value.as_str()))), scalar);
    let own = [head, &of_scalar(NUMBERS, scalar), &kernel, slow_path, &angles].join("\n");
    text += &format!("\n#if defined(REDYSIM_LIBM) || defined(REDYSIM_SINCOS)\n{}", of_scalar(LIBRARY_SIN_COS, scalar));
    if needed.without_turns {
        text += "\n/* Angles stay as they are. */\n#define redysim_without_turns(count, angles) ((void)(angles))\n";
    }
    text += &format!("#else\n{own}");
    if needed.without_turns {
        text += &format!("\n{}", of_scalar(TURNS, scalar));
    }
    text += "#endif\n";
    for (which, _) in [("sine", needed.sine), ("cosine", needed.cosine)].iter().filter(|(_, needed)| *needed) {
        text += &format!("\n{}", of_scalar(ONE_ANGLE, scalar).replace("@which@", which));
    }
    text
}

/// The parts before the functions over lanes, in `double`.
pub fn parts_of_lanes(needed: Needed) -> String {
    if !(needed.angles || needed.sine || needed.cosine) {
        return LANES.to_owned();
    }
    format!("{LANES}\n{}\n{LANES_SIN_COS}", in_vectors(&kernel_of(KERNEL_F64, CScalar::F64), CScalar::F64, "lanes"))
}

/// Sines and cosines of angles by the fast path, without branches.
fn kernel_of(kernel: &str, scalar: CScalar) -> String {
    format!("{}\n{kernel}", of_scalar(BITS, scalar))
}

/// Branches that are computed at once.
fn branches(abreast: Abreast, scalar: CScalar) -> String {
    let count = abreast.count().to_string();
    let names = [
        ("vector", vector(abreast.name(), &count, scalar.bits() * abreast.count(), scalar)),
        ("places", ["a", "b", "c", "d"][..abreast.count()].join(", ")),
        ("sqrt", scalar.of_math_h("sqrt")),
        ("name", abreast.name().to_owned()),
        ("NAME", abreast.name().to_uppercase()),
        ("count", count),
    ];
    of_scalar(&filled(BRANCHES, &names.each_ref().map(|(name, value)| (*name, value.as_str()))), scalar)
}

/// The suffix of vector types and of instructions on x86.
fn suffix_on_x86(scalar: CScalar) -> [&'static str; 2] {
    match scalar {
        CScalar::F64 => ["d", "pd"],
        CScalar::F32 => ["", "ps"],
    }
}

/// The type `redysim_name` of vectors of `count` numbers, which is an expression of the preprocessor. On x86 with fused
/// multiply-adds it has so many bits.
fn vector(name: &str, count: &str, bits_on_x86: usize, scalar: CScalar) -> String {
    let [kind, suffix] = suffix_on_x86(scalar);
    let (neon, neon_count) = match scalar {
        CScalar::F64 => ("float64x2_t", "2"),
        CScalar::F32 => ("float32x4_t", "4"),
    };
    let wide = if bits_on_x86 == 256 { "256" } else { "" };
    let names = [
        ("name", name),
        ("NAME", &name.to_uppercase()),
        ("count", count),
        ("x86", &format!("__m{bits_on_x86}{kind}")),
        ("x86_fma", &format!("_mm{wide}_fmadd_{suffix}")),
        ("neon", neon),
        ("neon_count", neon_count),
        ("neon_fma", &format!("vfmaq_f{}", scalar.bits())),
    ];
    of_scalar(&filled(VECTOR, &names), scalar)
}

/// Code over numbers as the same code over vectors.
fn in_vectors(code: &str, scalar: CScalar, name: &str) -> String {
    let vector = format!("redysim_{name}");
    let mut text = code.replace(scalar.type_name(), &vector);
    for bits in ["uint64_t", "uint32_t"] {
        text = text.replace(bits, &format!("{vector}_bits"));
    }
    text = text.replace("MULTIPLY_ADD", &format!("REDYSIM_{}_MULTIPLY_ADD", name.to_uppercase()));
    text = text.replace("redysim_bits number", &format!("{vector}_union number"));
    for function in ["bits_of", "number_of", "evaluate", "fast_reduction"] {
        text = text.replace(&format!("redysim_{function}("), &format!("{vector}_{function}("));
    }
    text
}

/// The check of an inertia tensor.
pub fn check_of_inertia(scalar: CScalar) -> String {
    of_scalar(PARAMETERS, scalar)
}

/// A part for the type of the numbers.
fn of_scalar(part: &str, scalar: CScalar) -> String {
    let [half_pi, half_pi_rest] = match scalar {
        CScalar::F64 => [std::f64::consts::FRAC_PI_2, 6.123_233_995_736_766e-17],
        CScalar::F32 => [std::f32::consts::FRAC_PI_2, -4.371_139e-8].map(f64::from),
    };
    let (group, epsilon) = match scalar {
        CScalar::F64 => ("4", f64::EPSILON),
        CScalar::F32 => ("8", f64::from(f32::EPSILON)),
    };
    let names = [
        ("number", scalar.type_name()),
        ("bits", &scalar.bits().to_string()),
        ("group", group),
        ("fma", &scalar.of_math_h("fma")),
        ("sin", &scalar.of_math_h("sin")),
        ("cos", &scalar.of_math_h("cos")),
        ("one", &scalar.literal(1.0)),
        ("seven", &scalar.literal(7.0)),
        ("half_pi", &scalar.literal(half_pi)),
        ("half_pi_rest", &scalar.literal(half_pi_rest)),
        ("roundoff", &CScalar::F64.literal(1e-9_f64.max(8.0 * epsilon))),
    ];
    filled(part, &names)
}

/// A part with values in place of its `@name@`s.
fn filled(part: &str, names: &[(&str, &str)]) -> String {
    names.iter().fold(part.to_owned(), |text, (name, value)| text.replace(&format!("@{name}@"), value))
}
