// One function that CasADi wrote, as a library. SOURCE is its file, CODE the function in it.
#include SOURCE

const double *SYMBOL(const double *state, double *result)
{
  const double *arguments[] = { state };
  double *results[] = { result };
  CODE(arguments, results, 0, 0, 0);
  return result;
}
