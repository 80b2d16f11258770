// Calls functions of libraries at the states of a file, and either writes what one returns, or times all of them in turns.
//
//   timer check STATES INPUTS OUTPUTS PROGRAM       results to standard output, binary
//   timer time  STATES INPUTS OUTPUTS PROGRAM ..    "ns-per-state calibration-ns" as text, a line for each program, or
//                                                   "interrupted" if other programs kept taking the core
//
// A PROGRAM is five arguments: LIBRARY SYMBOL ROBOT SCALAR LANES. Every program under comparison is a library with functions
// `const T *function(const T *state, T *result)`, T `double` (SCALAR f64) or `float` (f32). It returns where the result
// stands: in `result`, or in memory of its own. With LANES above 1, a call takes that many states at once, value by value:
// x1 of all states, then x2 of all. A library may have `int prepare(const char *robot)`, called first, and `SYMBOL_result`,
// called only in a check, for results that its users would not usually ask for in this form.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>

typedef const void *(*Function)(const void *state, void *result);

// Batches are short, so that few of them are interrupted, and so that all programs meet the same machine. The calibration loop
// runs between them.
static const double batch_ns = 4e5;
// Of the batches of a program, those count between whose calibration loops the core was most its own.
enum { batches = 160, quietest = batches / 4, attempts = 10 * batches, calibration_steps = 20000, warming_calls = 32 };

typedef struct {
  Function function, result_of;
  char *states;
  long calls, lanes, passes;
  size_t stride;
  int single, counted;
  // The calibration comes first: batches are sorted by it.
  struct { double calibration, time; } batches[batches];
} Program;

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

static void prepare(Program *program, char **arguments, const double *values, long states, long inputs)
{
  const char *library = arguments[0], *symbol = arguments[1], *robot = arguments[2];
  void *opened = need(dlopen(library, RTLD_NOW | RTLD_LOCAL), library);
  int (*reads)(const char *) = (int (*)(const char *))dlsym(opened, "prepare");
  if (reads && reads(robot) != 0) {
    fprintf(stderr, "timer: %s does not take %s\n", library, robot);
    exit(3);
  }
  char name[256];
  snprintf(name, sizeof name, "%s_result", symbol);
  program->function = (Function)need(dlsym(opened, symbol), symbol);
  program->result_of = (Function)dlsym(opened, name);
  program->single = strcmp(arguments[3], "f32") == 0;
  program->lanes = atol(arguments[4]);
  program->calls = states / program->lanes;
  program->states = arrange(values, states, inputs, program->lanes, program->single);
  program->stride = (size_t)(inputs * program->lanes) * (program->single ? sizeof(float) : sizeof(double));
}

static void check(const Program *program, void *result, long values)
{
  const char *state = program->states;
  for (long call = 0; call < program->calls; ++call, state += program->stride) {
    const void *found = program->function(state, result);
    if (program->result_of) found = program->result_of(state, result);
    for (long i = 0; i < values; ++i) {
      const double value = program->single ? (double)((const float *)found)[i] : ((const double *)found)[i];
      fwrite(&value, sizeof value, 1, stdout);
    }
  }
}

// ns of a call.
static double batch(const Program *program, void *result, long calls, long passes)
{
  const double begun = now();
  for (long pass = 0; pass < passes; ++pass) {
    const char *state = program->states;
    for (long call = 0; call < calls; ++call, state += program->stride) program->function(state, result);
  }
  return (now() - begun) / (double)(passes * calls);
}

static void warm(Program *program, void *result)
{
  batch(program, result, program->calls, 2);
  const double once = batch(program, result, program->calls, 1) * (double)program->calls;
  program->passes = once < batch_ns ? (long)(batch_ns / once) + 1 : 1;
  program->counted = 0;
}

// A batch of the program, unless it has all that it needs. One during which another program had the core says nothing of this
// one, and is not counted.
static void turn(Program *program, void *result)
{
  if (program->counted == batches) return;
  batch(program, result, program->calls < warming_calls ? program->calls : warming_calls, 1);
  const long before = interruptions();
  const double first = calibration();
  const double time = batch(program, result, program->calls, program->passes) / (double)program->lanes;
  const double last = calibration();
  if (interruptions() != before) return;
  program->batches[program->counted].calibration = first > last ? first : last;
  program->batches[program->counted++].time = time;
}

// The median of the quietest batches.
static void report(Program *program)
{
  if (program->counted < batches) {
    printf("interrupted\n");
    return;
  }
  double times[quietest];
  qsort(program->batches, batches, sizeof *program->batches, by_size);
  const double calibrated = program->batches[quietest / 2].calibration;
  for (int k = 0; k < quietest; ++k) times[k] = program->batches[k].time;
  qsort(times, quietest, sizeof *times, by_size);
  printf("%.17g %.17g\n", times[quietest / 2], calibrated);
}

int main(int count, char **arguments)
{
  enum { first = 5, each = 5 };
  const int programs = (count - first) / each;
  if (programs < 1 || (count - first) % each != 0) {
    fprintf(stderr, "usage: timer check|time STATES INPUTS OUTPUTS {LIBRARY SYMBOL ROBOT SCALAR LANES} ..\n");
    return 2;
  }
  const long inputs = atol(arguments[3]), outputs = atol(arguments[4]);
  long states, lanes = 1;
  const double *values = read_states(arguments[2], inputs, &states);
  Program *all = calloc((size_t)programs, sizeof *all);
  for (int k = 0; k < programs; ++k) {
    prepare(&all[k], arguments + first + each * k, values, states, inputs);
    if (all[k].lanes > lanes) lanes = all[k].lanes;
  }
  void *result = aligned_alloc(64, (size_t)(outputs * lanes * 8 + 63) / 64 * 64);
  if (strcmp(arguments[1], "check") == 0) {
    check(&all[0], result, outputs * all[0].lanes);
    return 0;
  }
  for (int k = 0; k < programs; ++k) warm(&all[k], result);
  for (int attempt = 0; attempt < attempts; ++attempt)
    for (int k = 0; k < programs; ++k) turn(&all[k], result);
  for (int k = 0; k < programs; ++k) report(&all[k]);
  return 0;
}
