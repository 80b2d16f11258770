// Pinocchio as its users call it: a model, its data, and one algorithm per function. Nothing is copied but what the
// algorithm itself writes; the mass matrix is its upper triangle, as the library leaves it.
#include <memory>

#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/algorithm/crba.hpp>
#include <pinocchio/algorithm/rnea.hpp>

#include "robot.hpp"

namespace
{
  pinocchio::Model model;
  std::unique_ptr<pinocchio::Data> data;

  using Input = Eigen::Map<const Eigen::VectorXd>;
  Input coordinates(const double * state)
  {
    return Input(state, model.nq);
  }
  Input velocities(const double * state)
  {
    return Input(state + model.nq, model.nv);
  }
  Input input(const double * state)
  {
    return Input(state + model.nq + model.nv, model.nv);
  }
} // namespace

extern "C" int prepare(const char * robot)
{
  model = read_robot(robot);
  data = std::make_unique<pinocchio::Data>(model);
  data->M.setZero();
  return 0;
}

extern "C" const double * inverse(const double * state, double *)
{
  return pinocchio::rnea(model, *data, coordinates(state), velocities(state), input(state)).data();
}

extern "C" const double * forward(const double * state, double *)
{
  return pinocchio::aba(
           model, *data, coordinates(state), velocities(state), input(state), pinocchio::Convention::LOCAL)
    .data();
}

extern "C" const double * forward_world(const double * state, double *)
{
  return pinocchio::aba(
           model, *data, coordinates(state), velocities(state), input(state), pinocchio::Convention::WORLD)
    .data();
}

extern "C" const double * mass(const double * state, double *)
{
  return pinocchio::crba(model, *data, coordinates(state), pinocchio::Convention::LOCAL).data();
}

extern "C" const double * mass_world(const double * state, double *)
{
  return pinocchio::crba(model, *data, coordinates(state), pinocchio::Convention::WORLD).data();
}
