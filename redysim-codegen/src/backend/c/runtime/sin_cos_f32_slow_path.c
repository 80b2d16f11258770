/* 2^n, for a result that is a normal number. */
static float redysim_power_of_two(int n)
{
    return redysim_number_of((uint32_t)(127 + n) << 23);
}

/*
 * The reduction of a number of at least 2^-6 by the digits of 2/pi that make the fraction of a quarter turn (M. H. Payne
 * and R. N. Hanek, Radian reduction for trigonometric functions, SIGNUM Newsletter 18, 1983).
 */
static redysim_reduced redysim_reduce(float x)
{
    /* The binary digits of 2/pi after the point, 32 at a time, behind 32 zeros. */
    static const uint32_t digits[8] = {
        0x00000000U, 0xa2f9836eU, 0x4e441529U, 0xfc2757d1U, 0xf534ddc0U, 0xdb629599U, 0x3c439041U, 0xfe5163abU,
    };
    redysim_reduced reduced;
    uint64_t first, second, third, fraction;
    uint32_t windows[3], top, rest, quarters;
    float rounded, tail, scale;
    int index, up, zeros = 0;
    const uint32_t bits = redysim_bits_of(x);
    const int exponent = (int)((bits >> 23) & 0xffU);
    /* |x| = mantissa * 2^(exponent - 150). Digits that this takes to 4 and more only add whole turns. */
    const uint64_t mantissa = (bits & 0x7fffffU) | 0x800000U;
    const int skipped = exponent > 120 ? exponent - 120 : 0;
    if (exponent == 0xff) {
        reduced.rounded = reduced.rest = reduced.tail = x - x;
        return reduced;
    }
    for (index = 0; index < 3; index++) {
        const int word = skipped / 32 + index;
        const uint64_t high = word < 8 ? digits[word] : 0U;
        const uint64_t low = word < 7 ? digits[word + 1] : 0U;
        windows[index] = (uint32_t)((((high << 32) | low) << (skipped % 32)) >> 32);
    }
    third = mantissa * windows[2];
    second = mantissa * windows[1] + (third >> 32);
    first = mantissa * windows[0] + (second >> 32);
    /* The number of quarter turns, with the point after two digits. */
    top = (uint32_t)first;
    fraction = ((uint64_t)top << 34) | ((second & 0xffffffffU) << 2) | ((third >> 30) & 3U);
    up = (int)(fraction >> 63);
    if (up) {
        fraction = 0U - fraction;
    }
    while (zeros < 63 && (fraction >> (63 - zeros)) == 0U) {
        zeros++;
    }
    /* Times pi/2 * 2^31. No float comes so close to a multiple of pi/2 that less than 32 digits were left. */
    rest = (uint32_t)((((fraction << zeros) >> 32) * 0xc90fdaa2U) >> 32);
    rounded = (float)rest;
    tail = (float)(int32_t)(rest - (uint32_t)rounded);
    scale = redysim_power_of_two(-31 - zeros);
    if ((x < 0.0f) != (up != 0)) {
        scale = -scale;
    }
    quarters = (top >> 30) + (uint32_t)up;
    if (x < 0.0f) {
        quarters = 0U - quarters;
    }
    reduced.rounded = redysim_number_of(quarters & 3U);
    reduced.rest = rounded * scale;
    reduced.tail = tail * scale;
    return reduced;
}
