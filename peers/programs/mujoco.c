// MuJoCo's core calls, without its collisions, contacts, actuators and sensors: what each function needs, in its order.
#include <stdio.h>
#include <string.h>

#include <mujoco/mujoco.h>

static mjModel *model;
static mjData *data;

// A root on a free joint. Its coordinates are x y z qx qy qz qw, in MuJoCo x y z qw qx qy qz; its linear velocity and
// force are along its own axes, in MuJoCo along the world's, with R from the one to the other: v' = R v, f' = R f,
// a' = R (a + w x v). The angular ones are along its own axes in both.
static int floats;

int prepare(const char *robot)
{
  char message[1000] = "";
  model = mj_loadXML(robot, NULL, message, sizeof message);
  if (!model) {
    fprintf(stderr, "MuJoCo: %s\n", message);
    return 1;
  }
  for (int body = 1; body < model->nbody; ++body) {
    // Moments that the compiler refuses, but that the dynamics can take.
    char name[32];
    snprintf(name, sizeof name, "inertia %d", body);
    const int number = mj_name2id(model, mjOBJ_NUMERIC, name);
    if (number >= 0) memcpy(model->body_inertia + 3 * body, model->numeric_data + model->numeric_adr[number], 3 * sizeof(mjtNum));
  }
  data = mj_makeData(model);
  floats = model->njnt > 0 && model->jnt_type[0] == mjJNT_FREE;
  return 0;
}

static void position(const double *state)
{
  memcpy(data->qpos, state, (size_t)model->nq * sizeof *state);
  if (floats) {
    data->qpos[3] = state[6];
    memcpy(data->qpos + 4, state + 3, 3 * sizeof *state);
  }
  mj_kinematics(model, data);
  mj_comPos(model, data);
}

// The orientation of the root, once its position is known.
static const double *root(void)
{
  return data->xmat + 9;
}

static void velocity(const double *state)
{
  memcpy(data->qvel, state + model->nq, (size_t)model->nv * sizeof *state);
  if (floats) mju_mulMatVec3(data->qvel, root(), state + model->nq);
  mj_comVel(model, data);
}

const double *inverse(const double *state, double *result)
{
  position(state);
  velocity(state);
  const double *v = state + model->nq, *a = v + model->nv;
  memcpy(data->qacc, a, (size_t)model->nv * sizeof *a);
  if (floats) {
    double of_origin[3];
    mju_cross(of_origin, v + 3, v);
    mju_addTo3(of_origin, a);
    mju_mulMatVec3(data->qacc, root(), of_origin);
  }
  mj_rne(model, data, 1, result);
  if (floats) {
    const double force[3] = { result[0], result[1], result[2] };
    mju_mulMatTVec3(result, root(), force);
  }
  return result;
}

const double *forward(const double *state, double *result)
{
  position(state);
  mj_makeM(model, data);
  mj_factorM(model, data);
  velocity(state);
  mj_rne(model, data, 0, data->qfrc_bias);
  const double *v = state + model->nq, *force = v + model->nv;
  memcpy(data->qfrc_smooth, force, (size_t)model->nv * sizeof *force);
  if (floats) mju_mulMatVec3(data->qfrc_smooth, root(), force);
  mju_subFrom(data->qfrc_smooth, data->qfrc_bias, model->nv);
  mj_solveM(model, data, result, data->qfrc_smooth, 1);
  if (floats) {
    const double of_origin[3] = { result[0], result[1], result[2] };
    double turning[3];
    mju_cross(turning, v + 3, v);
    mju_mulMatTVec3(result, root(), of_origin);
    mju_subFrom3(result, turning);
  }
  return result;
}

// The matrix stays in MuJoCo's sparse form, which its own solvers take.
const double *mass(const double *state, double *result)
{
  position(state);
  mj_makeM(model, data);
  return result;
}

const double *mass_result(const double *state, double *result)
{
  (void)state;
  mj_fullM(model, data, result);
  // Rows, then columns, of the root's linear velocity.
  const int n = floats ? model->nv : 0;
  for (int k = 0; k < n; ++k) {
    const double along[3] = { result[k], result[n + k], result[2 * n + k] };
    double turned[3];
    mju_mulMatTVec3(turned, root(), along);
    for (int i = 0; i < 3; ++i) result[i * n + k] = turned[i];
  }
  for (int k = 0; k < n; ++k) {
    const double along[3] = { result[k * n], result[k * n + 1], result[k * n + 2] };
    mju_mulMatTVec3(result + k * n, root(), along);
  }
  return result;
}
