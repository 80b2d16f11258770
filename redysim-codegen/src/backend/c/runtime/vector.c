typedef @number@ redysim_@name@ __attribute__((vector_size(@count@ * sizeof(@number@))));
typedef uint@bits@_t redysim_@name@_bits __attribute__((vector_size(@count@ * sizeof(@number@))));
typedef union {
    redysim_@name@ number;
    redysim_@name@_bits bits;
} redysim_@name@_union;

/* A number for each element, or a vector as it is: x - 0 is x, of either sign. */
#define REDYSIM_@NAME@_ALL(x) ((x) - (redysim_@name@){0})
#ifndef REDYSIM_FMA
#define REDYSIM_@NAME@_MULTIPLY_ADD(a, b, c) REDYSIM_@NAME@_ALL((a) * (b) + (c))
#else
#define REDYSIM_@NAME@_MULTIPLY_ADD(a, b, c) \
    redysim_@name@_multiply_add(REDYSIM_@NAME@_ALL(a), REDYSIM_@NAME@_ALL(b), REDYSIM_@NAME@_ALL(c))

REDYSIM_INLINE redysim_@name@ redysim_@name@_multiply_add(redysim_@name@ a, redysim_@name@ b, redysim_@name@ c)
{
#ifdef __aarch64__
    union {
        redysim_@name@ whole;
        @neon@ parts[@count@ / @neon_count@];
    } x, y, sum;
    x.whole = a;
    y.whole = b;
    sum.whole = c;
    for (int i = 0; i < @count@ / @neon_count@; i++) {
        sum.parts[i] = @neon_fma@(sum.parts[i], x.parts[i], y.parts[i]);
        REDYSIM_OPAQUE(sum.parts[i]);
    }
    return sum.whole;
#else
    redysim_@name@ sum = (redysim_@name@)@x86_fma@((@x86@)a, (@x86@)b, (@x86@)c);
    REDYSIM_OPAQUE(sum);
    return sum;
#endif
}
#endif
