#include "controller.h"

static const real_t KP = (real_t)400, KD = (real_t)40, WAY = (real_t)1.0471975511965976;

void desired_motion(real_t t, motion_t *desired)
{
    const real_t s = t < 0 ? (real_t)0 : t > 1 ? (real_t)1 : t;
    const real_t ss = s * s, rest = (real_t)1 - s;
    const real_t q = WAY * (ss * s * ((real_t)10 + s * ((real_t)6 * s - (real_t)15)));
    const real_t v = WAY * ((real_t)30 * (ss * (rest * rest)));
    const real_t a = WAY * ((real_t)60 * (s * (rest * (rest - s))));
    for (int i = 0; i < KR5_NV; i++) {
        desired->q[i] = q;
        desired->v[i] = v;
        desired->a[i] = a;
    }
}

void acceleration(const motion_t *desired, const real_t q[KR5_NQ], const real_t v[KR5_NV], real_t a[KR5_NV])
{
    for (int i = 0; i < KR5_NV; i++) {
        a[i] = desired->a[i] + KD * (desired->v[i] - v[i]) + KP * (desired->q[i] - q[i]);
    }
}

void control(real_t t, const real_t q[KR5_NQ], const real_t v[KR5_NV], real_t tau[KR5_NV])
{
    motion_t desired;
    real_t a[KR5_NV];
    desired_motion(t, &desired);
    acceleration(&desired, q, v, a);
    kr5_inverse_dynamics(q, v, a, tau);
}
