/* The KR5 under computed torque, and the motion that it follows. REAL is float or double, as in `kr5.h`. */
#ifndef CONTROLLER_H
#define CONTROLLER_H

#include "kr5.h"

typedef REAL real_t;

/* Position, velocity and acceleration of the joints. */
typedef struct {
    real_t q[KR5_NV], v[KR5_NV], a[KR5_NV];
} motion_t;

/* From rest to rest in one second, with the least jerk: every joint turns by pi/3 times 10 t^3 - 15 t^4 + 6 t^5. */
void desired_motion(real_t t, motion_t *desired);

/* The joint accelerations that lead onto the desired motion: the error e obeys e'' + 40 e' + 400 e = 0. */
void acceleration(const motion_t *desired, const real_t q[KR5_NQ], const real_t v[KR5_NV], real_t a[KR5_NV]);

/* The joint torques at time t, N m. */
void control(real_t t, const real_t q[KR5_NQ], const real_t v[KR5_NV], real_t tau[KR5_NV]);

#endif
