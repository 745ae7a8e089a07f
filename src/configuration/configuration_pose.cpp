#include "configuration/configuration_pose.h"

#include <Eigen/LU>
#include <cmath>
#include <vector>

#include "configuration/configuration_value.h"

namespace edgeslam {
namespace {

constexpr double rotation_tolerance = 1e-3;  // of a matrix's or a quaternion's departure from a rotation
constexpr double rounding = 1e-12;           // a quaternion so near to length 1 is kept to the last bit

// The numbers of a list, nested lists flattened by one level; false where anything else is in it.
bool readNumbers(const YAML::Node& node, std::vector<double>& numbers) {
  if (!node.IsSequence() || node.size() > 16) return false;
  for (const YAML::Node& entry : node) {
    if (entry.IsSequence() && entry.size() == 4) {
      for (const YAML::Node& inner : entry) {
        numbers.push_back(0);
        if (!inner.IsScalar() || !parseNumber(inner.Scalar(), numbers.back())) return false;
      }
    } else {
      numbers.push_back(0);
      if (!entry.IsScalar() || !parseNumber(entry.Scalar(), numbers.back())) return false;
    }
  }
  return true;
}

std::string poseFromMatrix(const YAML::Node& node, Pose& pose) {
  std::vector<double> n;
  if (!readNumbers(node, n) || n.size() != 16) return "16 finite numbers are expected";
  Eigen::Matrix3d rotation;
  rotation << n[0], n[1], n[2], n[4], n[5], n[6], n[8], n[9], n[10];
  const Eigen::Matrix3d rest = rotation * rotation.transpose() - Eigen::Matrix3d::Identity();
  if (!(rest.cwiseAbs().maxCoeff() < rotation_tolerance) || rotation.determinant() < 0) {
    return "its upper left 3x3 part is not a rotation";
  }
  if (n[12] != 0 || n[13] != 0 || n[14] != 0 || n[15] != 1) return "its last row is not 0 0 0 1";
  pose = {Eigen::Quaterniond(rotation).normalized(), {n[3], n[7], n[11]}};
  return "";
}

std::string poseFromMapping(const YAML::Node& node, Pose& pose) {
  std::vector<double> t, q;
  for (const auto& entry : node) {
    const std::string name = entry.first.IsScalar() ? entry.first.Scalar() : "";
    if (name == "translation") {
      if (!t.empty() || !readNumbers(entry.second, t) || t.size() != 3)
        return "translation must be three finite numbers [m]";
    } else if (name == "quaternion") {
      if (!q.empty() || !readNumbers(entry.second, q) || q.size() != 4)
        return "quaternion must be four finite numbers w x y z";
    } else {
      return "only translation and quaternion are expected here";
    }
  }
  if (t.empty() || q.empty()) return "both translation and quaternion are needed";
  const Eigen::Quaterniond rotation(q[0], q[1], q[2], q[3]);
  if (!(std::abs(rotation.norm() - 1) < rotation_tolerance)) return "the quaternion's length is not 1";
  const bool is_unit = std::abs(rotation.norm() - 1) < rounding;
  pose = {is_unit ? rotation : rotation.normalized(), {t[0], t[1], t[2]}};
  return "";
}

}  // namespace

std::string readPose(const YAML::Node& node, Pose& pose) {
  if (node.IsSequence()) return poseFromMatrix(node, pose);
  if (node.IsMap()) return poseFromMapping(node, pose);
  return "a 4x4 matrix or a mapping of translation and quaternion is expected";
}

std::string formatPose(const Pose& pose) {
  const Eigen::Vector3d& t = pose.translation;
  const Eigen::Quaterniond& q = pose.rotation;
  return "{translation: [" + numberText(t.x()) + ", " + numberText(t.y()) + ", " + numberText(t.z()) +
         "], quaternion: [" + numberText(q.w()) + ", " + numberText(q.x()) + ", " + numberText(q.y()) + ", " +
         numberText(q.z()) + "]}";
}

}  // namespace edgeslam
