// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/scans/time_text.h"

namespace gaussmap::detail {

/// What a column of a table of poses holds.
enum class PoseColumn {
  Skip,
  Key,  ///< a name, an index or a time: the content decides
  Name,
  Index,
  Time,
  Seconds,      ///< whole seconds of a time in two columns
  Nanoseconds,  ///< the rest of it
  X,
  Y,
  Z,
  QX,
  QY,
  QZ,
  QW,
  Roll,
  Pitch,
  Yaw,
  M11,  ///< first of the 12 elements of a 3 x 4 matrix, row by row
  MEnd = M11 + 12
};

inline PoseColumn matrixColumn(int element) {
  return static_cast<PoseColumn>(static_cast<int>(PoseColumn::M11) + element);
}

/// How the rotation of a pose is written.
enum class RotationKind { Quaternion, Matrix, RollPitchYaw };

/// The columns of a table of poses. Columns behind these are ignored.
struct PoseLayout {
  std::vector<PoseColumn> columns;
  RotationKind rotation = RotationKind::Quaternion;
  std::optional<TimeUnit> unit;                        ///< of the time, if it is stated
  bool degrees = false;                                ///< unit of roll, pitch and yaw
  std::optional<std::size_t> last_row = std::nullopt;  ///< column of the last row of a 4 x 4 matrix

  bool has(PoseColumn column) const;
  /// "time x y z qx qy qz qw"; matrices are "3 x 4 matrix".
  std::string text() const;
};

/// A layout, or why the names of columns do not give one.
struct NamedLayout {
  std::optional<PoseLayout> layout;
  std::string problem;      ///< empty if the layout is complete
  bool lacks_unit = false;  ///< only the unit of roll, pitch and yaw is missing
};

/// Reads the names of columns, for example "#timestamp, p_RS_R_x [m], q_RS_w []" or "time x y z qw qx qy qz". Commas,
/// semicolons or blanks separate the names. Unknown names are skipped.
NamedLayout layoutOfNames(std::string_view header);

/// Returns the number of names in a header.
std::size_t countNames(std::string_view header);

}  // namespace gaussmap::detail
