// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace gaussmap::detail {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kDegree = kPi / 180.0;  ///< [rad]

}  // namespace gaussmap::detail
