//! Andrews' squeezing mechanism: what the model file does not hold, and published numbers.
//!
//! Coordinates are the published ones, (β, Θ, γ, Φ, δ, Ω, ε), as in `models/andrews.toml`. Source: F. Mazzia, C.
//! Magherini, *Test Set for Initial Value Problem Solvers*, chapter "Andrews' squeezing mechanism"; IFToMM benchmark
//! library, A03.

/// The joint torques of the drive, N m.
pub const TORQUES: [f64; 7] = [0.033, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];

/// A consistent start at rest.
pub const START: [f64; 7] = [
    -0.061_713_890_014_276_45,
    0.0,
    0.455_279_819_163_070_37,
    0.222_668_390_165_885_88,
    0.487_364_979_543_842_55,
    -0.222_668_390_165_885_88,
    1.230_547_444_549_821_2,
];

/// The accelerations there.
pub const START_ACCELERATIONS: [f64; 7] = [14_222.443_919_954_114, -10_666.832_939_965_585, 0.0, 0.0, 0.0, 0.0, 0.0];

/// The multipliers there: the forces at the cuts, N.
pub const START_MULTIPLIERS: [f64; 6] = [98.566_870_396_241_09, -6.122_688_344_255_662, 0.0, 0.0, 0.0, 0.0];

/// At t = 0.03 s: coordinates, right to about 1e-10, ...
pub const END: [f64; 7] = [
    15.810_771_196_299_04,
    -15.756_371_059_842_98,
    0.040_822_240_130_731_01,
    -0.534_730_116_322_694_8,
    0.524_409_965_880_530_4,
    0.534_730_116_322_694_8,
    1.048_080_741_042_263,
];

/// ... velocities, to about 5e-8, ...
pub const END_VELOCITIES: [f64; 7] = [
    1_139.920_302_151_208,
    -1_424.379_294_994_111,
    11.032_912_219_371_34,
    19.293_374_644_213_85,
    0.573_569_928_479_080_8,
    -19.293_374_644_213_85,
    0.323_179_165_802_695_5,
];

/// ... accelerations, to about 1e-6, ...
pub const END_ACCELERATIONS: [f64; 7] = [
    -24_631.763_169_451_96,
    51_850.377_016_103_29,
    324_102.568_641_378_1,
    566_749.364_517_621_3,
    16_743.629_294_793_61,
    -566_749.364_517_622_2,
    9_826.520_791_458_422,
];

/// ... and multipliers, to about 1e-6.
pub const END_MULTIPLIERS: [f64; 6] = [
    199.175_333_373_191,
    -29.755_312_280_150_52,
    23.066_541_190_983_99,
    31.452_713_654_759_27,
    22.642_492_320_827_39,
    11.617_407_000_196_73,
];
