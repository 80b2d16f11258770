//! Sequences of Euler angles: the coordinates of an orientation as three rotations about axes of the moving body.

/// A sequence of Euler angles φ, θ, ψ: the orientation R₁(φ) R₂(θ) R₃(ψ), each a rotation about an axis of the body as
/// those before it have turned it.
///
/// The rates of the angles do not reach every angular velocity where the first and the third axis are parallel: at
/// θ = ±π/2 if the three axes are different, else at θ = 0 and θ = π.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[allow(missing_docs, reason = "each variant is named by its axes")]
pub enum EulerSequence {
    Xyz,
    Xzy,
    Yxz,
    Yzx,
    Zxy,
    Zyx,
    Xyx,
    Xzx,
    Yxy,
    Yzy,
    Zxz,
    Zyz,
}

impl EulerSequence {
    /// Every sequence with its name in a model file.
    pub const ALL: [(&'static str, EulerSequence); 12] = [
        ("xyz", EulerSequence::Xyz),
        ("xzy", EulerSequence::Xzy),
        ("yxz", EulerSequence::Yxz),
        ("yzx", EulerSequence::Yzx),
        ("zxy", EulerSequence::Zxy),
        ("zyx", EulerSequence::Zyx),
        ("xyx", EulerSequence::Xyx),
        ("xzx", EulerSequence::Xzx),
        ("yxy", EulerSequence::Yxy),
        ("yzy", EulerSequence::Yzy),
        ("zxz", EulerSequence::Zxz),
        ("zyz", EulerSequence::Zyz),
    ];

    /// Its name in a model file.
    pub fn name(self) -> &'static str {
        Self::ALL.iter().find(|(_, sequence)| *sequence == self).map_or("", |(name, _)| name)
    }

    /// The axes of the three rotations: 0 is x, 1 is y, 2 is z.
    pub fn axes(self) -> [usize; 3] {
        let name = self.name().as_bytes();
        std::array::from_fn(|i| usize::from(name[i] - b'x'))
    }
}
