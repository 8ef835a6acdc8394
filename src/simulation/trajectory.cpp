// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/trajectory.h"

#include <charconv>
#include <cmath>
#include <stdexcept>
#include <string>

#include "io/files/atomic_file.h"

namespace gaussmap {
using namespace detail;

void writeTum(const std::filesystem::path& path, const std::vector<TimedPose>& trajectory) {
  std::string text = "# time x y z qx qy qz qw\n";
  const auto add = [&text](double value, char after) {
    char digits[32];
    text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr) += after;
  };
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const auto& [time, pose] = trajectory[i];
    const std::string fault = std::isfinite(time) ? poseFault(pose) : "the time is not finite";
    if (!fault.empty()) throw std::invalid_argument("pose " + std::to_string(i) + " of the trajectory: " + fault);
    add(time, ' ');
    for (int axis = 0; axis < 3; ++axis) add(pose.translation(axis), ' ');
    for (const double value : {pose.rotation.x(), pose.rotation.y(), pose.rotation.z()}) add(value, ' ');
    add(pose.rotation.w(), '\n');
  }
  AtomicFile file(path);
  file.write(text.data(), text.size());
  file.commit();
}

}  // namespace gaussmap
