// Pinocchio's algorithms over a symbolic scalar: what both code generators start from.
#pragma once

#include <stdexcept>
#include <string>

#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/algorithm/crba.hpp>
#include <pinocchio/algorithm/rnea.hpp>

template<typename Scalar>
using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;

// The function named `function` at the state [q, v, input], as one vector. ABA is taken in the LOCAL convention: in the
// WORLD convention it has half as many operations more.
template<typename Scalar>
Vector<Scalar>
trace(const pinocchio::ModelTpl<Scalar> & model, const std::string & function, const Vector<Scalar> & state)
{
  const int m = model.nq, n = model.nv;
  const Vector<Scalar> q = state.segment(0, m), v = state.segment(m, n), input = state.segment(m + n, n);
  pinocchio::DataTpl<Scalar> data(model);
  if (function == "inverse")
    return pinocchio::rnea(model, data, q, v, input);
  if (function == "forward")
    return pinocchio::aba(model, data, q, v, input, pinocchio::Convention::LOCAL);
  if (function != "mass")
    throw std::runtime_error("no function is called " + function);
  // The algorithm leaves the upper triangle; whoever generates code says that the matrix is symmetric, at no operation.
  data.M.setZero();
  pinocchio::crba(model, data, q, pinocchio::Convention::LOCAL);
  Vector<Scalar> all(n * n);
  for (int row = 0; row < n; ++row)
    for (int column = 0; column < n; ++column)
      all[row * n + column] = data.M(std::min(row, column), std::max(row, column));
  return all;
}
