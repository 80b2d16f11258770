/*
 * The KR5 under computed torque at 1 kHz. Every millisecond the controller takes a sample and sets torques, which stay until
 * the next one; the robot, which is simulated here, moves on.
 */
#include "board.h"
#include "controller.h"

enum { SAMPLES = 1000 };
static const real_t PERIOD = (real_t)1e-3;

/* The robot starts 5 degrees beside the motion in every joint, and not at rest. */
static real_t q[KR5_NQ] = {(real_t)0.08726646259971647, (real_t)0.08726646259971647, (real_t)0.08726646259971647,
    (real_t)0.08726646259971647, (real_t)0.08726646259971647, (real_t)0.08726646259971647};
static real_t v[KR5_NV] = {(real_t)0, (real_t)0.4, (real_t)0.8, (real_t)-0.4, (real_t)-0.8, (real_t)-1.2};
static real_t a[KR5_NV], tau[KR5_NV];

/* The robot one period later: a step of the classical Runge-Kutta method. */
static void move(void)
{
    static const real_t step[4] = {(real_t)0, (real_t)0.5, (real_t)0.5, (real_t)1};
    static const real_t weight[4] = {(real_t)1, (real_t)2, (real_t)2, (real_t)1};
    real_t dq[KR5_NQ] = {0}, dv[KR5_NV] = {0}, sum_q[KR5_NQ] = {0}, sum_v[KR5_NV] = {0};
    for (int stage = 0; stage < 4; stage++) {
        real_t at_q[KR5_NQ], at_v[KR5_NV];
        for (int i = 0; i < KR5_NV; i++) {
            at_q[i] = q[i] + step[stage] * PERIOD * dq[i];
            at_v[i] = v[i] + step[stage] * PERIOD * dv[i];
        }
        kr5_forward_dynamics(at_q, at_v, tau, dv);
        for (int i = 0; i < KR5_NV; i++) {
            dq[i] = at_v[i];
            sum_q[i] += weight[stage] * dq[i];
            sum_v[i] += weight[stage] * dv[i];
        }
    }
    for (int i = 0; i < KR5_NV; i++) {
        q[i] += PERIOD / (real_t)6 * sum_q[i];
        v[i] += PERIOD / (real_t)6 * sum_v[i];
    }
}

static real_t largest(const real_t x[KR5_NV], const real_t y[KR5_NV])
{
    real_t largest = 0;
    for (int i = 0; i < KR5_NV; i++) {
        const real_t difference = x[i] < y[i] ? y[i] - x[i] : x[i] - y[i];
        /* NaN is taken as well. */
        largest = difference <= largest ? largest : difference;
    }
    return largest;
}

/* A number in millionths; the largest integer for one that is too large or not a number. */
static uint32_t micro(real_t x)
{
    return x < (real_t)4000 ? (uint32_t)((real_t)1e6 * x + (real_t)0.5) : 0xffffffffU;
}

static void nothing(const real_t *x, const real_t *y, const real_t *z, real_t *result)
{
    __asm volatile("" : : "r"(x), "r"(y), "r"(z), "r"(result) : "memory");
}

typedef void function_t(const real_t *, const real_t *, const real_t *, real_t *);

/* Ticks of a call. */
static uint32_t ticks_of(function_t *volatile function, const real_t *argument, real_t *result)
{
    const uint32_t start = board_ticks();
    function(q, v, argument, result);
    return board_ticks() - start;
}

/* Instructions of each of the calls: a tick is 40 ns, and QEMU takes 64 ns for an instruction. */
static uint32_t instructions(uint32_t ticks)
{
    return (40 * ticks + 32 * SAMPLES) / (64 * SAMPLES);
}

static void one_inverse(void)
{
    kr5_inverse_dynamics(q, v, a, tau);
}

static void one_forward(void)
{
    kr5_forward_dynamics(q, v, tau, a);
}

static void one_control(void)
{
    control((real_t)0.5, q, v, tau);
}

/* All bits of the state (FNV-1a). */
static uint32_t bits_of_state(void)
{
    uint32_t hash = 0x811c9dc5U;
    for (int vector = 0; vector < 2; vector++) {
        const unsigned char *bytes = (const unsigned char *)(vector == 0 ? q : v);
        for (unsigned i = 0; i < sizeof q; i++) {
            hash = (hash ^ bytes[i]) * 0x01000193U;
        }
    }
    return hash;
}

int main(void)
{
    uint32_t inverse = 0, forward = 0, cycle = 0, begun, last = 0;
    real_t lost = 0;
    motion_t desired;
    board_start();
    begun = board_wait();
    for (uint32_t sample = 0; sample <= SAMPLES; sample++) {
        const real_t t = PERIOD * (real_t)sample;
        desired_motion(t, &desired);
        last = micro(largest(desired.q, q));
        if (sample == 0 || sample == 100 || sample == 250 || sample == SAMPLES) {
            static const char *const names[] = {"error_0", "error_100", "error_250", "error_1000"};
            board_print(names[sample == 0 ? 0 : sample == 100 ? 1 : sample == 250 ? 2 : 3], last);
            begun = board_wait() - sample;
        }
        if (sample == SAMPLES) {
            break;
        }
        {
            /* What is measured are the torques; the forward dynamics must give back the acceleration. */
            real_t found[KR5_NV];
            uint32_t start, empty;
            acceleration(&desired, q, v, a);
            empty = ticks_of(nothing, a, found);
            inverse += ticks_of(kr5_inverse_dynamics, a, tau) - empty;
            forward += ticks_of(kr5_forward_dynamics, tau, found) - empty;
            lost = largest(a, found) > lost ? largest(a, found) : lost;
            start = board_ticks();
            control(t, q, v, tau);
            cycle += board_ticks() - start;
        }
        move();
        if (board_wait() != begun + sample + 1) {
            board_print("late_at", sample);
            board_exit(1);
        }
    }
    board_print("inverse", instructions(inverse));
    board_print("forward", instructions(forward));
    board_print("cycle", instructions(cycle));
    board_print("lost", micro(lost));
    board_print("bits", bits_of_state());
    board_print("stack_inverse", board_stack_of(one_inverse));
    board_print("stack_forward", board_stack_of(one_forward));
    board_print("stack_cycle", board_stack_of(one_control));
    board_exit(0);
    return 0;
}
