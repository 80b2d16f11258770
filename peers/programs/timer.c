// Calls one function of one library at the states of a file, and either writes what it returns, or times it.
//
//   timer check LIBRARY SYMBOL ROBOT STATES SCALAR LANES INPUTS OUTPUTS    results to standard output, binary
//   timer time  LIBRARY SYMBOL ROBOT STATES SCALAR LANES INPUTS OUTPUTS    "ns-per-state calibration-ns" as text
//
// Every program under comparison is a library with functions `const T *function(const T *state, T *result)`, T `double`
// (SCALAR f64) or `float` (f32). It returns where the result stands: in `result`, or in memory of its own. With LANES
// above 1, a call takes that many states at once, value by value: x1 of all states, then x2 of all. A library may have
// `int prepare(const char *robot)`, called first, and `SYMBOL_result`, called only in a check, for results that its
// users would not usually ask for in this form.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>

typedef const void *(*Function)(const void *state, void *result);

// Batches are short, so that few of them are interrupted. The calibration loop runs before each one.
static const double batch_ns = 4e5;
enum { batches = 41, attempts = 20 * batches, calibration_steps = 20000 };

static double now(void)
{
  struct timespec time;
  clock_gettime(CLOCK_MONOTONIC, &time);
  return 1e9 * (double)time.tv_sec + (double)time.tv_nsec;
}

// Independent chains of multiplications and additions that fill the core: slower when its clock falls, or when another
// thread shares it.
static double calibration(void)
{
  const double begun = now();
  double x[12] = { 0 };
  for (int step = 0; step < calibration_steps; ++step) {
    for (int chain = 0; chain < 12; ++chain) {
      x[chain] = x[chain] * 0.5 + 1.0;
      __asm__ volatile("" : "+x"(x[chain]));
    }
  }
  return now() - begun;
}

// How often the system took the core away from this program.
static long interruptions(void)
{
  struct rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_nivcsw;
}

static void *need(void *found, const char *what)
{
  if (!found) {
    fprintf(stderr, "timer: %s: %s\n", what, dlerror());
    exit(1);
  }
  return found;
}

static int by_size(const void *a, const void *b)
{
  const double difference = *(const double *)a - *(const double *)b;
  return (difference > 0) - (difference < 0);
}

static double median(double *values, int count)
{
  qsort(values, (size_t)count, sizeof *values, by_size);
  return values[count / 2];
}

static double *read_states(const char *path, long inputs, long *states)
{
  FILE *file = fopen(path, "rb");
  if (!file) {
    fprintf(stderr, "timer: cannot read %s\n", path);
    exit(1);
  }
  fseek(file, 0, SEEK_END);
  const long bytes = ftell(file);
  rewind(file);
  double *values = aligned_alloc(64, (size_t)(bytes + 63) / 64 * 64);
  if (fread(values, 1, (size_t)bytes, file) != (size_t)bytes) exit(1);
  fclose(file);
  *states = bytes / (inputs * (long)sizeof(double));
  return values;
}

// The states in the form that calls take: `lanes` states side by side, in the function's own scalar.
static char *arrange(const double *values, long states, long inputs, long lanes, int single)
{
  const size_t size = single ? sizeof(float) : sizeof(double);
  char *arranged = aligned_alloc(64, ((size_t)(states * inputs) * size + 63) / 64 * 64);
  for (long state = 0; state < states; ++state) {
    for (long input = 0; input < inputs; ++input) {
      const long at = (state / lanes * inputs + input) * lanes + state % lanes;
      const double value = values[state * inputs + input];
      if (single) ((float *)arranged)[at] = (float)value;
      else ((double *)arranged)[at] = value;
    }
  }
  return arranged;
}

static void check(Function function, Function result_of, const char *state, long calls, size_t stride, long values, int single)
{
  void *result = aligned_alloc(64, (size_t)(values * 8 + 63) / 64 * 64);
  for (long call = 0; call < calls; ++call, state += stride) {
    const void *found = function(state, result);
    if (result_of) found = result_of(state, result);
    for (long i = 0; i < values; ++i) {
      const double value = single ? (double)((const float *)found)[i] : ((const double *)found)[i];
      fwrite(&value, sizeof value, 1, stdout);
    }
  }
}

static double batch(Function function, const char *states, long calls, size_t stride, void *result, long passes)
{
  const double begun = now();
  for (long pass = 0; pass < passes; ++pass) {
    const char *state = states;
    for (long call = 0; call < calls; ++call, state += stride) function(state, result);
  }
  return (now() - begun) / (double)(passes * calls);
}

static void measure(Function function, const char *states, long calls, size_t stride, long values, long lanes)
{
  void *result = aligned_alloc(64, (size_t)(values * 8 + 63) / 64 * 64);
  batch(function, states, calls, stride, result, 2);
  const double once = batch(function, states, calls, stride, result, 1) * (double)calls;
  const long passes = once < batch_ns ? (long)(batch_ns / once) + 1 : 1;
  batch(function, states, calls, stride, result, 5 * passes);
  // A batch during which another program had the core says nothing of this one, and is not counted.
  double times[batches], calibrations[batches];
  int counted = 0;
  for (int attempt = 0; attempt < attempts && counted < batches; ++attempt) {
    const long before = interruptions();
    calibrations[counted] = calibration();
    times[counted] = batch(function, states, calls, stride, result, passes) / (double)lanes;
    if (interruptions() == before) ++counted;
  }
  if (counted < batches) {
    fprintf(stderr, "timer: other programs keep taking this core: stop them, or take another core (--core)\n");
    exit(4);
  }
  printf("%.17g %.17g\n", median(times, batches), median(calibrations, batches));
}

int main(int count, char **arguments)
{
  if (count != 10) {
    fprintf(stderr, "usage: timer check|time LIBRARY SYMBOL ROBOT STATES SCALAR LANES INPUTS OUTPUTS\n");
    return 2;
  }
  const char *symbol = arguments[3], *robot = arguments[4];
  const int single = strcmp(arguments[6], "f32") == 0;
  const long lanes = atol(arguments[7]), inputs = atol(arguments[8]), outputs = atol(arguments[9]);

  void *library = need(dlopen(arguments[2], RTLD_NOW | RTLD_LOCAL), arguments[2]);
  int (*prepare)(const char *) = (int (*)(const char *))dlsym(library, "prepare");
  if (prepare && prepare(robot) != 0) {
    fprintf(stderr, "timer: %s does not take %s\n", arguments[2], robot);
    return 3;
  }
  Function function = (Function)need(dlsym(library, symbol), symbol);
  char name[256];
  snprintf(name, sizeof name, "%s_result", symbol);
  Function result_of = (Function)dlsym(library, name);

  long states;
  double *values = read_states(arguments[5], inputs, &states);
  char *arranged = arrange(values, states, inputs, lanes, single);
  const size_t stride = (size_t)(inputs * lanes) * (single ? sizeof(float) : sizeof(double));
  if (strcmp(arguments[1], "check") == 0)
    check(function, result_of, arranged, states / lanes, stride, outputs * lanes, single);
  else
    measure(function, arranged, states / lanes, stride, outputs * lanes, lanes);
  return 0;
}
