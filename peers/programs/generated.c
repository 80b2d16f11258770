// One function that CppADCodeGen wrote, as a library. SOURCE is its file, and LANES how many states a call takes.
//
// With several lanes the same statements run over vectors of doubles; sine and cosine come from the C library's libmvec.
#define FUNCTION code

#if LANES == 1

#include <math.h>
typedef double scalar;
#define SPLAT(x) (x)

#else

typedef double scalar __attribute__((vector_size(8 * LANES)));
#define SPLAT(x) ((scalar){} + (x))

#if defined __AVX512F__
extern scalar _ZGVeN8v_sin(scalar), _ZGVeN8v_cos(scalar);
#define sin _ZGVeN8v_sin
#define cos _ZGVeN8v_cos
#else
// Half the lanes at a time, where the processor's vectors are half as long.
typedef double half __attribute__((vector_size(32)));
extern half _ZGVdN4v_sin(half), _ZGVdN4v_cos(half);
#define HALVES(name, of)                                                      \
  static inline scalar name(scalar x)                                         \
  {                                                                           \
    union { scalar all; half part[2]; } both = { x };                         \
    both.part[0] = of(both.part[0]);                                          \
    both.part[1] = of(both.part[1]);                                          \
    return both.all;                                                          \
  }
HALVES(sines, _ZGVdN4v_sin)
HALVES(cosines, _ZGVdN4v_cos)
#define sin sines
#define cos cosines
#endif

#endif

static
#include SOURCE

const scalar *SYMBOL(const scalar *state, scalar *result)
{
  code(state, result);
  return result;
}
