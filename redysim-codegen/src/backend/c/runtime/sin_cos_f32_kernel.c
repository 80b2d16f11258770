/* Sine and cosine of rest + tail, |rest| <= pi/4, turned by the quarters: each turns (sin, cos) to (cos, -sin). */
REDYSIM_INLINE void redysim_evaluate(float rounded, float rest, float tail, float *sine, float *cosine)
{
    const float z = rest * rest;
    const float s = MULTIPLY_ADD(MULTIPLY_ADD(-0.00019509163f, z, 0.008332114f), z, -0.16666654f);
    const float c = MULTIPLY_ADD(MULTIPLY_ADD(2.4435947e-5f, z, -0.0013887335f), z, 0.041666646f);
    const float sin_rest = rest + MULTIPLY_ADD(rest * z, s, tail);
    /* 1 - r^2/2 rounded, and what that loses. */
    const float half = 0.5f * z;
    const float near_one = 1.0f - half;
    const float lost = MULTIPLY_ADD(-rest, tail, (1.0f - near_one) - half);
    const float cos_rest = near_one + MULTIPLY_ADD(z * z, c, lost);
    const uint32_t turns = redysim_bits_of(rounded);
    const uint32_t sin_bits = redysim_bits_of(sin_rest);
    const uint32_t cos_bits = redysim_bits_of(cos_rest);
    /* Odd turns exchange them. The second bit of the turns is the sine's sign; the cosine's is its sum with the first. */
    const uint32_t differing = (sin_bits ^ cos_bits) & (0U - (turns & 1U));
    const uint32_t both = differing ^ ((turns << 30) & 0x80000000U);
    *sine = redysim_number_of(sin_bits ^ both);
    *cosine = redysim_number_of(cos_bits ^ both ^ (turns << 31));
}

/* The reduction that is accurate for few turns. The first bit of the result is set where it is not for this angle. */
REDYSIM_INLINE uint32_t redysim_fast_reduction(float x, float *rounded, float *rest, float *tail)
{
    const float n = MULTIPLY_ADD(x, 0.63661975f, REDYSIM_ROUNDER);
    const float minus_n = REDYSIM_ROUNDER - n;
    /* The first difference is exact. The second leaves its roundoff in the tail, with that of its product. */
    const float first = MULTIPLY_ADD(minus_n, REDYSIM_HALF_PI_1, x);
    const float product = minus_n * REDYSIM_HALF_PI_2;
    const float second = first + product;
    const float roundoff = (first - second) + product;
#ifdef REDYSIM_FMA
    *tail = roundoff + MULTIPLY_ADD(minus_n, REDYSIM_HALF_PI_3, MULTIPLY_ADD(minus_n, REDYSIM_HALF_PI_2, -product));
#else
    *tail = MULTIPLY_ADD(minus_n, REDYSIM_HALF_PI_3, roundoff);
#endif
    *rounded = n;
    *rest = second;
    return redysim_bits_of(REDYSIM_MOST * REDYSIM_MOST - x * x);
}
