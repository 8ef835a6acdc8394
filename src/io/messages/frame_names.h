// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <string>

namespace gaussmap::detail {

/// A step back in the times of one topic that is larger than this does not come from a delay.
inline constexpr std::chrono::milliseconds kMostStepBack{100};
/// What to do if the times of a recording step back.
inline constexpr const char* kResetAdvice =
    " in the order of the recording (was the simulated time reset?); use --log-times, or split the recording";

/// Returns the name of a frame without its namespace: "map" of "robot1/map".
inline std::string lastPart(const std::string& frame) {
  return frame.substr(frame.find_last_of('/') + 1);
}

/// Returns true for the usual names of frames that never move with a sensor.
inline bool isFixedFrame(const std::string& frame) {
  constexpr std::array<const char*, 5> kNames = {"map", "odom", "world", "earth", "camera_init"};
  return std::find(kNames.begin(), kNames.end(), lastPart(frame)) != kNames.end();
}

}  // namespace gaussmap::detail
