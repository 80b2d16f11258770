// Reads a robot of `peers/robots` into Pinocchio's model. The format is told in `peers/README.md`.
#pragma once

#include <fstream>
#include <stdexcept>
#include <string>

#include <pinocchio/multibody.hpp>

inline pinocchio::Model read_robot(const std::string & path)
{
  std::ifstream file(path);
  pinocchio::Model model;
  int joints = 0;
  Eigen::Vector3d gravity;
  file >> model.name >> joints >> gravity[0] >> gravity[1] >> gravity[2];
  model.gravity.linear() = gravity;
  for (int link = 0; link < joints; ++link)
  {
    std::string parent;
    double rotation[9], mass, i[6];
    Eigen::Vector3d position, com;
    file >> parent;
    for (double & entry : rotation)
      file >> entry;
    file >> position[0] >> position[1] >> position[2] >> mass >> com[0] >> com[1] >> com[2];
    for (double & entry : i)
      file >> entry;
    if (!file)
      throw std::runtime_error("cannot read link " + std::to_string(link + 1) + " of " + path);
    const Eigen::Matrix3d turn = Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rotation);
    Eigen::Matrix3d inertia;
    inertia << i[0], i[1], i[2], i[1], i[3], i[4], i[2], i[4], i[5];
    const pinocchio::SE3 placement(turn, position);
    const std::string name = "joint" + std::to_string(link + 1);
    // Joint 0 is the ground there, so that every joint's number is one higher than here.
    const auto joint = parent == "free"
      ? model.addJoint(0, pinocchio::JointModelFreeFlyer(), placement, name)
      : model.addJoint(static_cast<pinocchio::JointIndex>(std::stoi(parent) + 1), pinocchio::JointModelRZ(), placement, name);
    model.appendBodyToJoint(joint, pinocchio::Inertia(mass, com, inertia), pinocchio::SE3::Identity());
  }
  return model;
}
