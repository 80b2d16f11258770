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
  Input part(const double * state, int index)
  {
    return Input(state + index * model.nv, model.nv);
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
  return pinocchio::rnea(model, *data, part(state, 0), part(state, 1), part(state, 2)).data();
}

extern "C" const double * forward(const double * state, double *)
{
  return pinocchio::aba(model, *data, part(state, 0), part(state, 1), part(state, 2), pinocchio::Convention::LOCAL)
    .data();
}

extern "C" const double * forward_world(const double * state, double *)
{
  return pinocchio::aba(model, *data, part(state, 0), part(state, 1), part(state, 2), pinocchio::Convention::WORLD)
    .data();
}

extern "C" const double * mass(const double * state, double *)
{
  return pinocchio::crba(model, *data, part(state, 0), pinocchio::Convention::LOCAL).data();
}

extern "C" const double * mass_world(const double * state, double *)
{
  return pinocchio::crba(model, *data, part(state, 0), pinocchio::Convention::WORLD).data();
}
