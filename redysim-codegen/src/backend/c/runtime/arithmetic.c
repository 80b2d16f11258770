/*
 * No product is fused with a sum, so that results are the same to the bit on every processor. GCC knows no such pragma: its
 * -std=c99 implies -ffp-contract=off, its -std=gnu99 does not. With REDYSIM_FMA, multiply-adds are rounded once, which is
 * faster on processors that have an instruction for it.
 */
#if defined(__clang__) || !(defined(__GNUC__) || defined(_MSC_VER))
#pragma STDC FP_CONTRACT OFF
#elif defined(_MSC_VER)
#pragma fp_contract(off)
#endif
#if defined(__GNUC__)
#define REDYSIM_INLINE static inline __attribute__((always_inline, unused))
#define REDYSIM_SHARED static __attribute__((noinline))
#define REDYSIM_COLD static __attribute__((noinline, cold))
#else
#define REDYSIM_INLINE static inline
#define REDYSIM_SHARED static
#define REDYSIM_COLD static
#endif

/*
 * GCC makes one instruction of -fma(a, b, c), which gives zeros the other sign. Where the processor's registers are known here,
 * it does not see that a number is the result of one.
 */
#if defined(__GNUC__) && !defined(__clang__) && defined(__SSE2__)
#define REDYSIM_OPAQUE(x) __asm__("" : "+v"(x))
#elif defined(__GNUC__) && !defined(__clang__) && defined(__aarch64__)
#define REDYSIM_OPAQUE(x) __asm__("" : "+w"(x))
#endif
#if !defined(REDYSIM_FMA)
#define MULTIPLY_ADD(a, b, c) ((a) * (b) + (c))
#elif defined(REDYSIM_OPAQUE)
#define MULTIPLY_ADD(a, b, c) redysim_multiply_add((a), (b), (c))

REDYSIM_INLINE @number@ redysim_multiply_add(@number@ a, @number@ b, @number@ c)
{
    @number@ sum = @fma@(a, b, c);
    REDYSIM_OPAQUE(sum);
    return sum;
}
#else
#define MULTIPLY_ADD(a, b, c) @fma@((a), (b), (c))
#define REDYSIM_OPAQUE(x) ((void)0)
#endif

/*
 * Whether several numbers are computed at once, by vector extensions of GCC and Clang: angles whose sines are needed, and
 * branches of the mechanism that are alike. Results are the same bits. Multiply-adds that are rounded once need the
 * instruction.
 */
#ifndef REDYSIM_VECTORS
#if defined(__GNUC__) && (defined(__SSE2__) || defined(__aarch64__)) \
    && (!defined(REDYSIM_FMA) || defined(__FMA__) || defined(__aarch64__))
#define REDYSIM_VECTORS 1
#else
#define REDYSIM_VECTORS 0
#endif
#endif
#if REDYSIM_VECTORS
/* No function that takes vectors is called from outside of this file. */
#pragma GCC diagnostic ignored "-Wpsabi"
#if defined(__aarch64__)
#include <arm_neon.h>
#elif defined(__AVX__)
#include <immintrin.h>
#else
#include <emmintrin.h>
#endif
#endif

/* How many angles are computed at once, and the room that a number of angles takes. */
#if !REDYSIM_VECTORS || defined(REDYSIM_LIBM) || defined(REDYSIM_SINCOS)
#define REDYSIM_GROUP 1
#elif defined(__AVX__)
#define REDYSIM_GROUP @group@
#else
#define REDYSIM_GROUP (@group@ / 2)
#endif
#define REDYSIM_ROOM(count) (((count) + REDYSIM_GROUP - 1) / REDYSIM_GROUP * REDYSIM_GROUP)
