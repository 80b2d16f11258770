//! What the kernels of sine and cosine ask of lanes.

use super::{F32x4, F32x8, F32x16, F64x2, F64x4, F64x8};
use crate::registers::Register;
use crate::scalar::FUSED;
use crate::trigonometry::angle::Angle;
use bytemuck::cast;
use wide::{u32x4, u32x8, u32x16, u64x2, u64x4, u64x8};

macro_rules! angles {
    ($lanes:ident of $float:ident, $bits:ident << $second_bit_to_sign:literal) => {
        impl Angle for $lanes {
            type Number = $float;
            const FUSED: bool = FUSED;

            #[inline(always)]
            fn all_at_most(self, limit: Self) -> bool {
                // Not by the comparison of `wide`, whose result LLVM takes for numbers of which it needs the signs.
                let mut all = true;
                for (number, limit) in self.to_array().into_iter().zip(limit.to_array()) {
                    all &= number <= limit;
                }
                all
            }

            #[inline(always)]
            fn lesser(self, other: Self) -> Self {
                // Where an operand is NaN, the minimum is the second operand on x86-64 and the first one in WebAssembly.
                if cfg!(target_feature = "simd128") {
                    Self(other.0.fast_min(self.0))
                } else {
                    Self(self.0.fast_min(other.0))
                }
            }

            #[inline(always)]
            fn turned(rounded: Self, sin: Self, cos: Self) -> (Self, Self) {
                let (one, three) = ($bits::splat(1), $bits::splat(3));
                let [turns, sin, cos]: [$bits; 3] = [cast(rounded.0), cast(sin.0), cast(cos.0)];
                let odd = Self(cast($bits::splat(0) - (turns & one))).0;
                // The second bit of the turns becomes the sign. The first one moves to the bit below; after odd turns it is
                // removed there, and the cosine changes its sign.
                let turns = turns << $second_bit_to_sign;
                let (sin, cos) = (sin ^ turns, cos ^ turns);
                let odd_sin = cos ^ (one << $second_bit_to_sign);
                let odd_cos = sin ^ (three << $second_bit_to_sign);
                (Self(odd.select(cast(odd_sin), cast(sin))), Self(odd.select(cast(odd_cos), cast(cos))))
            }

            #[inline(always)]
            fn one_by_one(self, function: impl Fn($float) -> ($float, $float)) -> (Self, Self) {
                // A call that is not inlined takes the address of its lanes, which would keep these lanes in memory
                // from where they are put together; and to read as a whole what was just written in parts stalls.
                // Negative lanes are other lanes, made only when they are needed.
                (-self).negatives_one_by_one(function)
            }
        }

        impl $lanes {
            /// `function` of the negative of each lane.
            #[inline(never)]
            #[cold]
            fn negatives_one_by_one(self, function: impl Fn($float) -> ($float, $float)) -> (Self, Self) {
                let (mut sin, mut cos) = (self.to_array(), self.to_array());
                for (sin, cos) in sin.iter_mut().zip(&mut cos) {
                    let (one_sin, one_cos) = function(-*sin);
                    [*sin, *cos] = [one_sin, one_cos].map(Register::apart);
                }
                (Self::from(sin), Self::from(cos))
            }
        }
    };
}

impl F64x2 {
    /// The sine and the cosine in these lanes after the quarter turns in the last two bits of `rounded`.
    #[inline(always)]
    pub(crate) fn turned_as_sine_and_cosine(self, rounded: f64) -> (f64, f64) {
        let turns: u64x2 = cast([rounded, rounded]);
        let odd = u64x2::splat(0) - (turns & u64x2::splat(1));
        let [sin, cos] = self.to_array();
        let [found, exchanged]: [u64x2; 2] = [cast(self.0), cast([cos, sin])];
        let differing = (found ^ exchanged) & odd;
        // The cosine is the sine a quarter turn later.
        let signs = ((turns + u64x2::new([0, 1])) & u64x2::splat(2)) << 62_u64;
        let [sin, cos] = cast(found ^ differing ^ signs);
        (sin, cos)
    }
}

angles!(F64x2 of f64, u64x2 << 62_u64);
angles!(F64x4 of f64, u64x4 << 62_u64);
angles!(F64x8 of f64, u64x8 << 62_u64);
angles!(F32x4 of f32, u32x4 << 30_u32);
angles!(F32x8 of f32, u32x8 << 30_u32);
angles!(F32x16 of f32, u32x16 << 30_u32);
