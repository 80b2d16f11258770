/*
 * Calls a function of a mechanism at the states of ../instructions/src/main.rs, where the same functions in Rust are
 * counted. ROBOT is the prefix, SOURCE the file, included so that functions may be inlined as they are there.
 */
#include SOURCE

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#define JOINED(a, b) a##b
#define OF(robot, name) JOINED(robot, name)

enum { NV = NUMBER, CALLS = 64 };

typedef struct {
    double q[NV], v[NV], a[NV];
} state_t;

__attribute__((noinline)) void counted_inverse_dynamics(const state_t *state, double *result)
{
    OF(ROBOT, _inverse_dynamics)(state->q, state->v, state->a, result);
}

__attribute__((noinline)) void counted_forward_dynamics(const state_t *state, double *result)
{
    OF(ROBOT, _forward_dynamics)(state->q, state->v, state->a, result);
}

__attribute__((noinline)) void counted_mass_matrix(const state_t *state, double *result)
{
    OF(ROBOT, _mass_matrix)(state->q, (double (*)[NV])result);
}

/* As in ../instructions: how often the time of all rounds is taken, of which the least counts. */
enum { REPETITIONS = 40 };

static state_t states[CALLS];
static double result[NV * NV];

static void call_all(char function)
{
    for (int call = 0; call < CALLS; call++) {
        switch (function) {
        case 'i': counted_inverse_dynamics(&states[call], result); break;
        case 'f': counted_forward_dynamics(&states[call], result); break;
        default: counted_mass_matrix(&states[call], result);
        }
        /* All of the result is read. */
        __asm__ volatile("" : : : "memory");
    }
}

/* With a number of rounds behind the function's name: prints the least time of a call, ns. */
int main(int count, char **arguments)
{
    static const double bounds[3] = {3.141592653589793, 3.0, 10.0};
    double number = 0.0, least = INFINITY;
    if (count < 2) {
        return 2;
    }
    for (int call = 0; call < CALLS; call++) {
        double *numbers[3] = {states[call].q, states[call].v, states[call].a};
        for (int vector = 0; vector < 3; vector++) {
            for (int i = 0; i < NV; i++) {
                number += 1.0;
                const double multiple = number * 1.618033988749895;
                numbers[vector][i] = bounds[vector] * (2.0 * (multiple - (double)(long)multiple) - 1.0);
            }
        }
    }
    if (count == 2) {
        call_all(arguments[1][0]);
        return 0;
    }
    const int rounds = atoi(arguments[2]);
    for (int repetition = 0; repetition < REPETITIONS; repetition++) {
        struct timespec start, end;
        clock_gettime(CLOCK_MONOTONIC, &start);
        for (int round = 0; round < rounds; round++) {
            call_all(arguments[1][0]);
        }
        clock_gettime(CLOCK_MONOTONIC, &end);
        const double elapsed = (double)(end.tv_sec - start.tv_sec) * 1e9 + (double)(end.tv_nsec - start.tv_nsec);
        const double time = elapsed / (rounds * CALLS);
        least = time < least ? time : least;
    }
    printf("%.1f\n", least);
    return 0;
}
