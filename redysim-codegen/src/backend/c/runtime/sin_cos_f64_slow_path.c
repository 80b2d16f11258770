/* An integer of 128 bits. */
typedef struct {
    uint64_t high;
    uint64_t low;
} redysim_long;

static redysim_long redysim_product(uint64_t a, uint64_t b)
{
    const uint64_t half = 0xffffffffU;
    const uint64_t low = (a & half) * (b & half);
    const uint64_t first = (a >> 32) * (b & half) + (low >> 32);
    const uint64_t second = (a & half) * (b >> 32) + (first & half);
    redysim_long product;
    product.high = (a >> 32) * (b >> 32) + (first >> 32) + (second >> 32);
    product.low = (second << 32) | (low & half);
    return product;
}

static redysim_long redysim_negative(redysim_long a)
{
    a.high = ~a.high + (a.low == 0U);
    a.low = 0U - a.low;
    return a;
}

static int redysim_leading_zeros(uint64_t a)
{
    int zeros = 0;
    while (zeros < 64 && (a >> (63 - zeros)) == 0U) {
        zeros++;
    }
    return zeros;
}

/* a * 2^n, 0 <= n < 128. */
static redysim_long redysim_shifted(redysim_long a, int n)
{
    if (n >= 64) {
        a.high = a.low;
        a.low = 0U;
        n -= 64;
    }
    if (n > 0) {
        a.high = (a.high << n) | (a.low >> (64 - n));
        a.low <<= n;
    }
    return a;
}

/* 2^n, for a result that is a normal number. */
static double redysim_power_of_two(int n)
{
    return redysim_number_of((uint64_t)(1023 + n) << 52);
}

/* The nearest double. */
static double redysim_nearest(redysim_long a)
{
    int zeros;
    if (a.high == 0U) {
        return (double)a.low;
    }
    zeros = redysim_leading_zeros(a.high);
    a = redysim_shifted(a, zeros);
    /* What is cut off leaves its mark in the last of 64 bits, of which the conversion rounds 11 away. */
    return (double)(a.high | (a.low != 0U)) * redysim_power_of_two(64 - zeros);
}

/* By pi/2 in three parts of 33 bits, of which multiples up to 2^20 are exact, and a fourth of 53. */
static redysim_reduced redysim_reduce_by_parts(double x)
{
    redysim_reduced reduced;
    const double rounded = x * REDYSIM_2_PI + REDYSIM_ROUNDER;
    const double n = rounded - REDYSIM_ROUNDER;
    const double p1 = n * 6.077100506303966e-11;
    const double p2 = n * 2.0222662487111665e-21;
    /* The first difference is exact; the others leave their roundoff in the tail (Knuth). */
    const double first = x - n * 1.5707963267341256;
    const double second = first - p1;
    const double virtual_p1 = first - second;
    const double tail_2 = (first - (second + virtual_p1)) + (virtual_p1 - p1);
    const double third = second - p2;
    const double virtual_p2 = second - third;
    const double tail_3 = (second - (third + virtual_p2)) + (virtual_p2 - p2);
    const double tail = (tail_2 + tail_3) - n * 8.4784276603689e-32;
    reduced.rounded = rounded;
    reduced.rest = third + tail;
    reduced.tail = (third - reduced.rest) + tail;
    return reduced;
}

/*
 * By the digits of 2/pi that make the fraction of a quarter turn (M. H. Payne and R. N. Hanek, Radian reduction for
 * trigonometric functions, SIGNUM Newsletter 18, 1983).
 */
static redysim_reduced redysim_reduce_by_digits(double x)
{
    /* The binary digits of 2/pi after the point, 64 at a time, behind 64 zeros. */
    static const uint64_t digits[22] = {
        0x0000000000000000U, 0xa2f9836e4e441529U, 0xfc2757d1f534ddc0U, 0xdb6295993c439041U, 0xfe5163abdebbc561U,
        0xb7246e3a424dd2e0U, 0x06492eea09d1921cU, 0xfe1deb1cb129a73eU, 0xe88235f52ebb4484U, 0xe99c7026b45f7e41U,
        0x3991d639835339f4U, 0x9c845f8bbdf9283bU, 0x1ff897ffde05980fU, 0xef2f118b5a0a6d1fU, 0x6d367ecf27cb09b7U,
        0x4f463f669e5fea2dU, 0x7527bac7ebe5f17bU, 0x3d0739f78a5292eaU, 0x6bfb5fb11f8d5d08U, 0x56033046fc7b6babU,
        0xf0cfbc209af4361dU, 0xa9e391615ee61b08U,
    };
    redysim_reduced reduced;
    redysim_long fraction, rest, left;
    uint64_t product[4], quarters, carry = 0U;
    double rounded, tail, scale;
    int index, up, zeros;
    const uint64_t bits = redysim_bits_of(x);
    const int exponent = (int)((bits >> 52) & 0x7ffU);
    /* |x| = mantissa * 2^(exponent - 1075). Digits that this takes to 4 and more only add whole turns. */
    const uint64_t mantissa = (bits & 0xfffffffffffffU) | 0x10000000000000U;
    const int skipped = exponent > 1013 ? exponent - 1013 : 0;
    if (exponent == 0x7ff) {
        reduced.rounded = reduced.rest = reduced.tail = x - x;
        return reduced;
    }
    for (index = 3; index >= 0; index--) {
        const int word = skipped / 64 + index;
        redysim_long window, sum;
        window.high = word < 22 ? digits[word] : 0U;
        window.low = word < 21 ? digits[word + 1] : 0U;
        sum = redysim_product(mantissa, redysim_shifted(window, skipped % 64).high);
        sum.low += carry;
        sum.high += sum.low < carry;
        product[index] = sum.low;
        carry = sum.high;
    }
    /* The number of quarter turns, with the point after two digits. */
    fraction.high = (product[0] << 2) | (product[1] >> 62);
    fraction.low = (product[1] << 2) | (product[2] >> 62);
    up = (int)(fraction.high >> 63);
    if (up) {
        fraction = redysim_negative(fraction);
    }
    zeros = fraction.high != 0U ? redysim_leading_zeros(fraction.high) : 64 + redysim_leading_zeros(fraction.low);
    zeros = zeros < 127 ? zeros : 127;
    /* Times pi/2 * 2^63. */
    rest = redysim_product(redysim_shifted(fraction, zeros).high, 0xc90fdaa22168c234U);
    rounded = redysim_nearest(rest);
    left.high = rest.high - (uint64_t)(rounded * 5.421010862427522e-20);
    left.low = rest.low;
    tail = left.high >> 63 ? -redysim_nearest(redysim_negative(left)) : redysim_nearest(left);
    scale = redysim_power_of_two(-127 - zeros);
    if ((x < 0.0) != (up != 0)) {
        scale = -scale;
    }
    quarters = (product[0] >> 62) + (uint64_t)up;
    if (x < 0.0) {
        quarters = 0U - quarters;
    }
    reduced.rounded = redysim_number_of(quarters & 3U);
    reduced.rest = rounded * scale;
    reduced.tail = tail * scale;
    return reduced;
}

static redysim_reduced redysim_reduce(double x)
{
    /* Up to 2^20 quarter turns; not so for NaN. */
    const int by_parts = x >= -1647099.0 && x <= 1647099.0;
    return by_parts ? redysim_reduce_by_parts(x) : redysim_reduce_by_digits(x);
}
