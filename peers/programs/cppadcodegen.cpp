// Writes C for one function of one robot by CppADCodeGen: cppadcodegen <robot.txt> <function> <out.c>
//
// The C is over `scalar`, which is `double`, or a vector of doubles for several states at once.
#include <iostream>
#include <regex>

#include <pinocchio/codegen/cppadcg.hpp>

#include "robot.hpp"
#include "symbolic.hpp"

int main(int count, char ** arguments)
{
  if (count != 4)
  {
    std::cerr << "usage: cppadcodegen <robot.txt> <inverse|forward|mass> <out.c>\n";
    return 2;
  }
  using Coded = CppAD::cg::CG<double>;
  using Scalar = CppAD::AD<Coded>;
  const auto model = read_robot(arguments[1]).cast<Scalar>();

  Vector<Scalar> state = Vector<Scalar>::Zero(model.nq + 2 * model.nv);
  CppAD::Independent(state);
  const Vector<Scalar> result = trace<Scalar>(model, arguments[2], state);
  CppAD::ADFun<Coded> function(state, result);
  function.optimize("no_compare_op");

  CppAD::cg::CodeHandler<double> handler;
  CppAD::vector<Coded> inputs(static_cast<size_t>(state.size()));
  handler.makeVariables(inputs);
  CppAD::vector<Coded> outputs = function.Forward(0, inputs);
  CppAD::cg::LanguageC<double> language("scalar");
  CppAD::cg::LangCDefaultVariableNameGenerator<double> names("y", "x", "v");
  language.setParameterPrecision(17);
  std::ostringstream body;
  handler.generateCode(body, language, outputs, names);

  std::ofstream file(arguments[3]);
  file << "void FUNCTION(const scalar *x, scalar *y)\n{\n"
       << "  scalar v[" << std::max<size_t>(1, handler.getTemporaryVariableCount()) << "];\n"
       // A constant alone is no vector.
       << std::regex_replace(body.str(), std::regex(" = ([-+.e0-9]+);"), " = SPLAT($1);") << "}\n";
  return file ? 0 : 1;
}
