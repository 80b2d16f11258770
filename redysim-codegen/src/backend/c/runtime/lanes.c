/*
 * Lanes: the same number of several states, in a vector of this processor, by vector extensions of GCC and Clang. Results are
 * the same to the bit as those of one state.
 */
#if defined(__AVX512F__)
#define REDYSIM_LANES 8
#elif defined(__AVX__)
#define REDYSIM_LANES 4
#else
#define REDYSIM_LANES 2
#endif
#if defined(__AVX__)
#include <immintrin.h>
#elif defined(__SSE2__)
#include <emmintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#endif

/*
 * From here to the end, vectors have what bits there are, also where the command line keeps GCC's code for one state to 256 of
 * them (-mprefer-vector-width=256).
 */
#if defined(__AVX512F__) && defined(__GNUC__) && !defined(__clang__) && __GNUC__ >= 12
#pragma GCC target("prefer-vector-width=none")
#endif

typedef double redysim_lanes __attribute__((vector_size(8 * REDYSIM_LANES)));
typedef uint64_t redysim_lanes_bits __attribute__((vector_size(8 * REDYSIM_LANES)));
typedef union {
    redysim_lanes number;
    redysim_lanes_bits bits;
} redysim_lanes_union;

/* A number in all lanes, or lanes as they are: x - 0 is x, of either sign. */
#define REDYSIM_LANES_ALL(x) ((x) - (redysim_lanes){0})
#define REDYSIM_LANES_MULTIPLY_ADD(a, b, c) \
    redysim_lanes_multiply_add(REDYSIM_LANES_ALL(a), REDYSIM_LANES_ALL(b), REDYSIM_LANES_ALL(c))

REDYSIM_INLINE redysim_lanes redysim_lanes_multiply_add(redysim_lanes a, redysim_lanes b, redysim_lanes c)
{
#if !defined(REDYSIM_FMA)
    return a * b + c;
#else
    redysim_lanes sum;
#if defined(__AVX512F__)
    sum = (redysim_lanes)_mm512_fmadd_pd((__m512d)a, (__m512d)b, (__m512d)c);
#elif defined(__AVX__) && defined(__FMA__)
    sum = (redysim_lanes)_mm256_fmadd_pd((__m256d)a, (__m256d)b, (__m256d)c);
#elif defined(__aarch64__)
    sum = (redysim_lanes)vfmaq_f64((float64x2_t)c, (float64x2_t)a, (float64x2_t)b);
#else
    for (int lane = 0; lane < REDYSIM_LANES; lane++) {
        sum[lane] = fma(a[lane], b[lane], c[lane]);
    }
#endif
    REDYSIM_OPAQUE(sum);
    return sum;
#endif
}

REDYSIM_INLINE redysim_lanes redysim_lanes_square_root(redysim_lanes a)
{
#if defined(__AVX512F__)
    return (redysim_lanes)_mm512_sqrt_pd((__m512d)a);
#elif defined(__AVX__)
    return (redysim_lanes)_mm256_sqrt_pd((__m256d)a);
#elif defined(__SSE2__)
    return (redysim_lanes)_mm_sqrt_pd((__m128d)a);
#elif defined(__aarch64__)
    return (redysim_lanes)vsqrtq_f64((float64x2_t)a);
#else
    redysim_lanes root;
    for (int lane = 0; lane < REDYSIM_LANES; lane++) {
        root[lane] = sqrt(a[lane]);
    }
    return root;
#endif
}

/* The numbers of several states, which follow each other at a stride, in lanes. */
REDYSIM_INLINE void redysim_lanes_read(int count, const double *x, size_t stride, redysim_lanes *lanes)
{
    for (int i = 0; i < count; i++, x++) {
#if REDYSIM_LANES == 8
        lanes[i] = (redysim_lanes){x[0], x[stride], x[2 * stride], x[3 * stride],
            x[4 * stride], x[5 * stride], x[6 * stride], x[7 * stride]};
#elif REDYSIM_LANES == 4
        lanes[i] = (redysim_lanes){x[0], x[stride], x[2 * stride], x[3 * stride]};
#else
        lanes[i] = (redysim_lanes){x[0], x[stride]};
#endif
    }
}

REDYSIM_INLINE void redysim_lanes_write(int count, const redysim_lanes *lanes, double *x)
{
    for (int i = 0; i < count; i++) {
        for (int lane = 0; lane < REDYSIM_LANES; lane++) {
            x[lane * count + i] = lanes[i][lane];
        }
    }
}
