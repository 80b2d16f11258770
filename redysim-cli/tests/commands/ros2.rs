//! The plugin of docs/ros2.md compiles against the interface that it implements, and its parts agree.

use crate::common::{all_tools, bash, skip};
use crate::documented::run_all;
use std::fs;

/// The declarations of the interface, version 2.0, that a plugin sees.
const INTERFACE: &str = r"
#pragma once
#include <memory>
#include <string>
#include <tuple>
#include <Eigen/Core>
namespace rclcpp { namespace node_interfaces {
struct NodeParametersInterface { using ConstSharedPtr = std::shared_ptr<const NodeParametersInterface>; };
} }
namespace inverse_dynamics_solver {
class InverseDynamicsSolver {
public:
  virtual ~InverseDynamicsSolver() {}
  virtual void initialize(rclcpp::node_interfaces::NodeParametersInterface::ConstSharedPtr = nullptr, const std::string & = {},
    const std::string & = {}) = 0;
  virtual Eigen::MatrixXd getInertiaMatrix(const Eigen::VectorXd &) const = 0;
  virtual Eigen::VectorXd getCoriolisVector(const Eigen::VectorXd &, const Eigen::VectorXd &) const = 0;
  virtual Eigen::VectorXd getGravityVector(const Eigen::VectorXd &) const = 0;
  virtual Eigen::VectorXd getFrictionVector(const Eigen::VectorXd &) const = 0;
  virtual Eigen::VectorXd getTorques(const Eigen::VectorXd &, const Eigen::VectorXd &, const Eigen::VectorXd &) const = 0;
};
}
";

const USER: &str = r#"
#include "../src/solver.cpp"
#include <iostream>
int main() {
  kr5_inverse_dynamics_solver::Solver plugin;
  const inverse_dynamics_solver::InverseDynamicsSolver & solver = plugin;
  plugin.initialize(nullptr, "", "");
  Eigen::VectorXd q(6), v(6), a(6);
  q << 0.3, -0.8, 1.1, 2.0, -9.0, 0.7;
  v << 1.0, -2.0, 3.0, 0.5, -0.25, 2.0;
  a << -1.0, 4.0, 0.5, 2.0, 1.0, -3.0;
  const Eigen::VectorXd parts = solver.getInertiaMatrix(q) * a + solver.getCoriolisVector(q, v) + solver.getGravityVector(q);
  const Eigen::VectorXd torques = solver.getTorques(q, v, a);
  // Roundoff of a few hundred operations.
  if (!((torques - parts).norm() < 1e-12 * torques.norm() && torques.norm() > 10.0 && solver.getCoriolisVector(q, v).norm() > 1.0)) {
    std::cerr << torques << "\n\n" << parts << "\n";
    return 1;
  }
  if (solver.getFrictionVector(v).norm() != 0.0) return 2;
  try { solver.getGravityVector(Eigen::VectorXd::Zero(5)); return 3; } catch (const std::invalid_argument & error) {
    std::cout << error.what() << "\n";
  }
}
"#;

#[test]
fn the_plugin_for_ros_2_compiles_and_its_torques_are_the_sum_of_its_parts() {
    let (folder, _) = run_all("documented-ros2", "docs/ros2.md", 2);
    if !all_tools() {
        skip("Eigen is not used");
        return;
    }
    let package = folder.join("kr5_inverse_dynamics_solver");
    let write = |path: &str, text: &str| {
        let path = package.join("test").join(path);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    };
    write("inverse_dynamics_solver/inverse_dynamics_solver.hpp", INTERFACE);
    write(
        "pluginlib/class_list_macros.hpp",
        "#define PLUGINLIB_EXPORT_CLASS(plugin, base) static_assert(true, \"\");\n",
    );
    write("user.cpp", USER);
    let command = "cc -std=c99 -c kr5/kr5.c -o kr5.o && c++ -std=c++17 -pedantic -Wall -Wextra -Werror -Itest -Ikr5 \
        -isystem /usr/include/eigen3 test/user.cpp kr5.o -o user && ./user";
    let run = bash(&package, command, &[]);
    assert_eq!(run.code, 0, "{}", run.output());
    assert!(run.stdout.contains("5 joint positions instead of 6"), "{}", run.output());
}
