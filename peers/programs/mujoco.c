// MuJoCo's core calls, without its collisions, contacts, actuators and sensors: what each function needs, in its order.
#include <stdio.h>
#include <string.h>

#include <mujoco/mujoco.h>

static mjModel *model;
static mjData *data;

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
  return 0;
}

static void position(const double *state)
{
  memcpy(data->qpos, state, (size_t)model->nv * sizeof *state);
  mj_kinematics(model, data);
  mj_comPos(model, data);
}

static void velocity(const double *state)
{
  memcpy(data->qvel, state + model->nv, (size_t)model->nv * sizeof *state);
  mj_comVel(model, data);
}

const double *inverse(const double *state, double *result)
{
  position(state);
  velocity(state);
  memcpy(data->qacc, state + 2 * model->nv, (size_t)model->nv * sizeof *state);
  mj_rne(model, data, 1, result);
  return result;
}

const double *forward(const double *state, double *result)
{
  position(state);
  mj_makeM(model, data);
  mj_factorM(model, data);
  velocity(state);
  mj_rne(model, data, 0, data->qfrc_bias);
  for (int joint = 0; joint < model->nv; ++joint)
    data->qfrc_smooth[joint] = state[2 * model->nv + joint] - data->qfrc_bias[joint];
  mj_solveM(model, data, result, data->qfrc_smooth, 1);
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
  return result;
}
