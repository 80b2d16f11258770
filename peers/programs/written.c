// Writes VALUES numbers of LANES states each, all zero, and computes nothing: a lower bound for every program that writes a
// result of this size.
typedef double scalar __attribute__((vector_size(8 * LANES)));

const scalar *SYMBOL(const scalar *state, scalar *result)
{
  (void)state;
  for (long value = 0; value < VALUES; ++value) result[value] = (scalar){};
  return result;
}
