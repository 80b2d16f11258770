/* Sine and cosine of rest + tail, |rest| <= pi/4, turned by the quarters: each turns (sin, cos) to (cos, -sin). */
REDYSIM_INLINE void redysim_evaluate(double rounded, double rest, double tail, double *sine, double *cosine)
{
    const double z = rest * rest;
    const double zz = z * z;
    const double s0 = MULTIPLY_ADD(z, 0.008333333333322418, -0.16666666666666632);
    const double s1 = MULTIPLY_ADD(z, 2.755731369357263e-6, -0.0001984126982981238);
    const double s2 = MULTIPLY_ADD(z, 1.5896811798732654e-10, -2.5050758384371987e-8);
    const double s = MULTIPLY_ADD(zz, MULTIPLY_ADD(zz, s2, s1), s0);
    const double c0 = MULTIPLY_ADD(z, -0.0013888888888874131, 0.0416666666666666);
    const double c1 = MULTIPLY_ADD(z, -2.755731435378898e-7, 2.4801587289487012e-5);
    const double c2 = MULTIPLY_ADD(z, -1.1359658844005114e-11, 2.087572347902117e-9);
    const double c3 = MULTIPLY_ADD(zz, c2, c1);
    /* Halves are exact. */
#ifdef REDYSIM_FMA
    const double sin_rest = rest + MULTIPLY_ADD(rest * z, s, tail);
    /* The product rest * (-rest/2) is exact, so that it needs no correction. */
    const double beyond_second_order = MULTIPLY_ADD(zz * zz, c3, MULTIPLY_ADD(zz, c0, -rest * tail));
    const double cos_rest = 1.0 + MULTIPLY_ADD(rest, rest * -0.5, beyond_second_order);
#else
    const double near_one = MULTIPLY_ADD(z, -0.5, 1.0);
    const double sin_rest = rest + MULTIPLY_ADD(rest * z, s, tail * near_one);
    const double correction = MULTIPLY_ADD(-rest, tail, MULTIPLY_ADD(z, -0.5, 1.0 - near_one));
    const double cos_rest = near_one + MULTIPLY_ADD(zz, MULTIPLY_ADD(zz, c3, c0), correction);
#endif
    const uint64_t turns = redysim_bits_of(rounded);
    const uint64_t sin_bits = redysim_bits_of(sin_rest);
    const uint64_t cos_bits = redysim_bits_of(cos_rest);
    /*
     * Odd turns exchange them. The second bit of the turns is the sine's sign; the cosine's is that of one turn more, which
     * compilers turn into vectors, other than the sum of two bits.
     */
    const uint64_t differing = (sin_bits ^ cos_bits) & (0U - (turns & 1U));
    *sine = redysim_number_of(sin_bits ^ differing ^ ((turns & 2U) << 62));
    *cosine = redysim_number_of(cos_bits ^ differing ^ (((turns + 1U) & 2U) << 62));
}

/* The reduction that is accurate for nearly all angles. The first bit of the result is set where it is not for this one. */
REDYSIM_INLINE uint64_t redysim_fast_reduction(double x, double *rounded, double *rest, double *tail)
{
    const double n = MULTIPLY_ADD(x, REDYSIM_2_PI, REDYSIM_ROUNDER);
    const double minus_n = REDYSIM_ROUNDER - n;
    /* The first difference is exact; the second leaves its roundoff in the tail. */
    const double first = MULTIPLY_ADD(minus_n, REDYSIM_HALF_PI_HIGH, x);
    const double second = MULTIPLY_ADD(minus_n, REDYSIM_HALF_PI_LOW, first);
    const double subtracted = first - second;
    /*
     * Too many quarter turns, or a rest that has lost too many digits to cancellation, make one of two differences negative.
     * Squares need no absolute values, and redysim_evaluate computes that of the rest anyway.
     */
#ifdef REDYSIM_FMA
    /* Roundoff leaves the numbers nearest to multiples of pi/2 a difference little below zero, more than -2^-150. */
    const double few_turns = MULTIPLY_ADD(-subtracted, subtracted, 2.3283064365386963e-10);
    const double large_rest = MULTIPLY_ADD(-subtracted, subtracted, second * second) + 7.006492321624085e-46;
#else
    /* At most 2^17 quarter turns, and a rest of at least 2^-33 for each of them. */
    const double few_turns = MULTIPLY_ADD(-minus_n, minus_n, 17179869184.0);
    const double large_rest = MULTIPLY_ADD(minus_n * -1.3552527156068805e-20, minus_n, second * second);
#endif
    *rounded = n;
    *rest = second;
    *tail = MULTIPLY_ADD(minus_n, REDYSIM_HALF_PI_LOW, subtracted);
    return redysim_bits_of(few_turns) | redysim_bits_of(large_rest);
}
