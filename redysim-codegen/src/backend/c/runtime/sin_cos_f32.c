/*
 * Sine and cosine of redysim, as in the Rust crate redysim-runtime, to the same bits, in float and integers only. Errors
 * stay below 1 unit in the last place for every finite angle; an angle that is not finite gives NaN.
 *
 * The angle is reduced to |r| <= pi/4 with a tail that carries what a float cannot: by subtracting pi/2 in three parts, or,
 * after many turns, in integers. Then two polynomials in r^2, of least relative error, are evaluated.
 */
/* C23 (5.2.5.3.3): with 16 and 32, only types narrower than float are computed as wider ones. */
#if FLT_EVAL_METHOD != 0 && FLT_EVAL_METHOD != 16 && FLT_EVAL_METHOD != 32
#error "float is computed with excess precision: compile with -msse2 -mfpmath=sse, or define REDYSIM_LIBM"
#endif
#ifdef __FAST_MATH__
#error "-ffast-math breaks the reduction of angles: compile without it, or define REDYSIM_LIBM"
#endif

/* Added to a number below 2^22 and taken away again, it leaves the nearest integer, and shows its bits in between. */
#define REDYSIM_ROUNDER 12582912.0f
/*
 * pi/2 in three parts, and the number of radians up to which they are accurate enough. If multiply and add round
 * once, a multiple of the first is subtracted exactly though it has all 24 bits: up to 2^17 quarter turns. If
 * they round twice, the first and the second have 16 bits, of which multiples up to 2^8 are exact.
 */
#ifdef REDYSIM_FMA
#define REDYSIM_HALF_PI_1 1.5707964f
#define REDYSIM_HALF_PI_2 (-4.371139e-8f)
#define REDYSIM_HALF_PI_3 (-1.7151245e-15f)
#define REDYSIM_MOST 205887.0f
#else
#define REDYSIM_HALF_PI_1 1.5707703f
#define REDYSIM_HALF_PI_2 2.6063062e-5f
#define REDYSIM_HALF_PI_3 6.0771006e-11f
#define REDYSIM_MOST 402.0f
#endif
