// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "gaussmap/io/scans/pose_file.h"
#include "io/scans/pose_columns.h"

// Readers of the kinds of pose files. readPoseFile() chooses between them.
namespace gaussmap::detail {

/// A line that is not empty.
struct TextLine {
  std::size_t number = 0;  ///< from 1
  std::string_view text;
};

/// The lines of a pose file.
struct PoseText {
  std::filesystem::path path;
  std::vector<TextLine> lines;     ///< without comments
  std::vector<TextLine> comments;  ///< those before the first line
  char separator = ' ';            ///< between fields; a blank also separates at tabs

  [[noreturn]] void fail(std::size_t line, const std::string& what) const;
};

PoseText splitPoseText(const std::filesystem::path& path, std::string_view text);

/// Returns the fields of a line. Words before the trailing numbers of a line become one field, if `join_name` is set,
/// because names can contain blanks.
std::vector<std::string_view> fieldsOf(const PoseText& text, std::string_view line, bool join_name = true);

/// Returns the numbers of the fields from `first` on; empty if one of them is not a number.
std::vector<double> numbersOf(const std::vector<std::string_view>& fields, std::size_t first);

/// Makes a pose of 12 numbers, row by row. Calls text.fail() if they are not a rotation and a translation.
Pose poseOfMatrix(const PoseText& text, std::size_t line, const double* elements);
/// Returns true if the 12 numbers are a rotation and a translation.
bool isRigid(const double* elements);
/// Returns what is wrong with the last row of the 16 numbers of a matrix; empty if it is 0 0 0 1, or all are NaN.
/// `any_corner`: the last element can be another number.
std::string lastRowFault(const double* elements, bool any_corner = false);

/// Reads a table with the given columns, from the line `first` on.
PoseFile readPoseTable(const PoseText& text, const PoseLayout& layout, std::size_t first);

/// Returns the layout that fits the numbers of the lines from `first` on, and its kind. Calls text.fail() if none or
/// several fit.
struct InferredLayout {
  PoseLayout layout;
  PoseFormat format = PoseFormat::Tum;
  bool index_behind = false;
};
InferredLayout inferLayout(const PoseText& text, std::size_t first);

/// Returns the layout of a kind that is not recognised but given. Calls text.fail() if the lines cannot have it.
PoseLayout layoutOfFormat(const PoseText& text, PoseFormat format, std::size_t first);

/// Returns true if the lines are matrices over several lines, with or without a line of numbers before each.
bool isBlocks(const PoseText& text);
PoseFile readPoseBlocks(const PoseText& text);

/// Returns true if the file is a pose graph.
bool isPoseGraph(const PoseText& text);
PoseFile readPoseGraph(const PoseText& text);

}  // namespace gaussmap::detail
