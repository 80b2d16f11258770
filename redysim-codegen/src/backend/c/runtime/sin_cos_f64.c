/*
 * Sine and cosine of redysim, as in the Rust crate redysim-runtime, to the same bits. Errors stay below 1 unit in the last
 * place for every finite angle; an angle that is not finite gives NaN.
 *
 * The angle is reduced to |r| <= pi/4 with a tail that carries what a double cannot: by subtracting pi/2 in two parts, or,
 * where that is not enough (many quarter turns, or an angle beside a multiple of pi/2), with more digits. Then two
 * polynomials in r^2, of least relative error, are evaluated.
 */
/* C23 (5.2.5.3.3): with 16, 32 and 64, only types narrower than double are computed as wider ones. */
#if FLT_EVAL_METHOD != 0 && FLT_EVAL_METHOD != 1 && FLT_EVAL_METHOD != 16 && FLT_EVAL_METHOD != 32 && \
    FLT_EVAL_METHOD != 64
#error "double is computed with excess precision: compile with -msse2 -mfpmath=sse, or define REDYSIM_LIBM"
#endif
#ifdef __FAST_MATH__
#error "-ffast-math breaks the reduction of angles: compile without it, or define REDYSIM_LIBM"
#endif

/* Added to a number below 2^51 and taken away again, it leaves the nearest integer, and shows its bits in between. */
#define REDYSIM_ROUNDER 6755399441055744.0
#define REDYSIM_2_PI 0.6366197723675814

/*
 * pi/2 in two parts. With fused multiply-adds the first part has full precision, and x - n * pi/2 is exact. Without them the
 * first part has 36 bits, so that its multiples up to 2^17 are exact.
 */
#ifdef REDYSIM_FMA
#define REDYSIM_HALF_PI_HIGH 1.5707963267948966
#define REDYSIM_HALF_PI_LOW 6.123233995736766e-17
#else
#define REDYSIM_HALF_PI_HIGH 1.5707963267923333
#define REDYSIM_HALF_PI_LOW 2.563344151594519e-12
#endif
