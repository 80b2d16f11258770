//! The floating-point type of generated C, and how its numbers are written.

/// The floating-point type that generated C computes with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CScalar {
    /// `double`.
    #[default]
    F64,
    /// `float`: no operation and no constant is a `double`.
    F32,
}

impl CScalar {
    /// The name of the type in C.
    pub fn type_name(self) -> &'static str {
        match self {
            CScalar::F64 => "double",
            CScalar::F32 => "float",
        }
    }

    /// How many bits a number has.
    pub(crate) fn bits(self) -> usize {
        match self {
            CScalar::F64 => 64,
            CScalar::F32 => 32,
        }
    }

    /// A number in full precision: the shortest digits that give the same number of this type.
    pub fn literal(self, value: f64) -> String {
        let (digits, is_finite) = match self {
            CScalar::F64 => (format!("{value:?}"), value.is_finite()),
            // Rounded here, since the digits of the `f64` might be rounded to another `float`.
            CScalar::F32 => (format!("{:?}f", value as f32), (value as f32).is_finite()),
        };
        if is_finite {
            return digits;
        }
        // No checked model has such a number. If one arises all the same, the result shows it. In `math.h` they are
        // numbers of the type `float`.
        let (sign, name) = (if value < 0.0 { "-" } else { "" }, if value.is_nan() { "NAN" } else { "INFINITY" });
        format!("{sign}({}){name}", self.type_name())
    }

    /// The number that [`literal`](Self::literal) writes.
    pub fn rounded(self, value: f64) -> f64 {
        match self {
            CScalar::F64 => value,
            CScalar::F32 => f64::from(value as f32),
        }
    }

    /// The name of a function of `math.h` for this type.
    pub fn of_math_h(self, function: &str) -> String {
        match self {
            CScalar::F64 => function.to_string(),
            CScalar::F32 => format!("{function}f"),
        }
    }
}

/// What a variable of generated C holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Numbers {
    /// A number of one state.
    One(CScalar),
    /// A number of one state for each of as many branches as are computed at once.
    Branches(CScalar, Abreast),
    /// A number, of type `double`, of each of several states.
    Lanes,
}

/// How many branches are computed at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Abreast {
    /// Two.
    Two,
    /// Four.
    Four,
}

impl Abreast {
    /// For so many branches that are alike. In `float`, a vector of two numbers would be half of one.
    pub fn of(branches: usize, scalar: CScalar) -> Self {
        if branches == 2 && scalar == CScalar::F64 { Abreast::Two } else { Abreast::Four }
    }

    /// How many they are.
    pub fn count(self) -> usize {
        match self {
            Abreast::Two => 2,
            Abreast::Four => 4,
        }
    }

    /// The number as a word.
    pub fn name(self) -> &'static str {
        match self {
            Abreast::Two => "two",
            Abreast::Four => "four",
        }
    }

    /// The beginning of the names of macros.
    pub fn macros(self) -> String {
        format!("REDYSIM_{}", self.name().to_uppercase())
    }
}

impl Numbers {
    /// The name of the type in C.
    pub fn type_name(self) -> &'static str {
        match self {
            Numbers::One(scalar) => scalar.type_name(),
            Numbers::Branches(_, Abreast::Two) => "redysim_two",
            Numbers::Branches(_, Abreast::Four) => "redysim_four",
            Numbers::Lanes => "redysim_lanes",
        }
    }

    /// The type of constants.
    pub fn constant(self) -> CScalar {
        match self {
            Numbers::One(scalar) | Numbers::Branches(scalar, _) => scalar,
            Numbers::Lanes => CScalar::F64,
        }
    }

    /// What variables hold for branches that are alike.
    pub fn of_branches(self, branches: usize) -> Self {
        match self {
            Numbers::One(scalar) => Numbers::Branches(scalar, Abreast::of(branches, scalar)),
            Numbers::Branches(..) | Numbers::Lanes => self,
        }
    }

    /// How many variables hold the numbers of so many branches, as an expression of the preprocessor.
    pub fn groups(self, branches: usize) -> String {
        match self {
            Numbers::Branches(_, abreast) => format!("{}S({branches})", abreast.macros()),
            Numbers::One(_) | Numbers::Lanes => branches.to_string(),
        }
    }

    /// The numbers of all branches as the initialiser of an array, without its braces. Places without a branch repeat the
    /// last one.
    pub fn initialiser(self, mut values: Vec<String>) -> String {
        let Numbers::Branches(_, abreast) = self else { return values.join(", ") };
        while let Some(last) = values.last().filter(|_| !values.len().is_multiple_of(abreast.count())) {
            values.push(last.clone());
        }
        let groups = values.chunks(abreast.count()).map(|group| format!("{}({})", abreast.macros(), group.join(", ")));
        groups.collect::<Vec<_>>().join(", ")
    }

    /// The number of one branch in an array.
    pub fn of_branch(self, array: &str, branch: usize) -> String {
        match self {
            Numbers::Branches(_, abreast) => format!("{}_AT({array}, {branch})", abreast.macros()),
            Numbers::One(_) | Numbers::Lanes => format!("{array}[{branch}]"),
        }
    }

    /// An expression of constants alone as a value of a variable.
    pub fn of_constants(self, expression: String) -> String {
        match self {
            Numbers::One(_) => expression,
            Numbers::Branches(_, abreast) => format!("{}_ALL({expression})", abreast.macros()),
            Numbers::Lanes => format!("REDYSIM_LANES_ALL({expression})"),
        }
    }

    /// The macro for a · b + c.
    pub fn multiply_add(self) -> String {
        match self {
            Numbers::One(_) => "MULTIPLY_ADD".to_owned(),
            Numbers::Branches(_, abreast) => format!("{}_MULTIPLY_ADD", abreast.macros()),
            Numbers::Lanes => "REDYSIM_LANES_MULTIPLY_ADD".to_owned(),
        }
    }

    /// The function or macro for a square root.
    pub fn square_root(self) -> String {
        match self {
            Numbers::One(scalar) => scalar.of_math_h("sqrt"),
            Numbers::Branches(_, abreast) => format!("{}_SQUARE_ROOT", abreast.macros()),
            Numbers::Lanes => "redysim_lanes_square_root".to_owned(),
        }
    }

    /// The function `sine`, `cosine` or `sin_cos` of redysim.
    pub fn trigonometry(self, function: &str) -> String {
        match self {
            Numbers::One(_) => format!("redysim_{function}"),
            Numbers::Branches(..) | Numbers::Lanes => format!("{}_{function}", self.type_name()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn literals_read_back_to_the_same_number_of_the_type() {
        for value in [0.1, -2.5e-17, 1e300, 4e-40, 1.0 + f64::EPSILON, 16777217.0, 0.0, -0.0] {
            assert_eq!(CScalar::F64.literal(value).parse::<f64>().unwrap().to_bits(), value.to_bits());
            let text = CScalar::F32.literal(value);
            if let Some(digits) = text.strip_suffix('f') {
                assert_eq!(digits.parse::<f32>().unwrap().to_bits(), (value as f32).to_bits());
            } else {
                assert_eq!((value, text.as_str()), (1e300, "(float)INFINITY"));
            }
        }
        assert_eq!(
            [f64::NAN, f64::NEG_INFINITY].map(|x| CScalar::F64.literal(x)),
            ["(double)NAN", "-(double)INFINITY"]
        );
    }
}
