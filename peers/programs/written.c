// Writes VALUES numbers of LANES states each, all zero, and computes nothing: what every program takes at least that leaves
// a result of this size in memory.
typedef double scalar __attribute__((vector_size(8 * LANES)));

const scalar *SYMBOL(const scalar *state, scalar *result)
{
  (void)state;
  for (long value = 0; value < VALUES; ++value) result[value] = (scalar){};
  return result;
}
