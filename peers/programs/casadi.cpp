// Writes C for one function of one robot by CasADi: casadi <robot.txt> <function> <folder>; the file is <function>.c
#include <iostream>

#include <pinocchio/autodiff/casadi.hpp>

#include "robot.hpp"
#include "symbolic.hpp"

int main(int count, char ** arguments)
{
  if (count != 4)
  {
    std::cerr << "usage: casadi <robot.txt> <inverse|forward|mass> <folder>\n";
    return 2;
  }
  using Scalar = casadi::SX;
  const auto model = read_robot(arguments[1]).cast<Scalar>();
  const Scalar symbols = Scalar::sym("x", model.nq + 2 * model.nv);
  Vector<Scalar> state(model.nq + 2 * model.nv);
  for (int i = 0; i < state.size(); ++i)
    state[i] = symbols(i);
  const Vector<Scalar> result = trace<Scalar>(model, arguments[2], state);
  Scalar outputs = Scalar::zeros(result.size());
  for (int i = 0; i < result.size(); ++i)
    outputs(i) = result[i];
  const casadi::Function function(
    std::string("casadi_") + arguments[2], {symbols}, {casadi::SX::densify(outputs)}, casadi::Dict{{"cse", true}});
  casadi::CodeGenerator generator(std::string(arguments[2]) + ".c");
  generator.add(function);
  generator.generate(std::string(arguments[3]) + "/");
  return 0;
}
