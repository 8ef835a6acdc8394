// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

// Samples of the columns of a file, from which the meaning of columns without names is found.
namespace gaussmap::detail {

/// Numbers of one column, from rows that are spread over the file.
struct ColumnSample {
  std::vector<double> values;  ///< NaN if the word is not a number
  bool numeric = true;         ///< false: a word in this column is not a number
  std::string text = {};       ///< the first such word
  std::size_t text_line = 0;   ///< its line
};

/// Returns true if all numbers of a sample are whole and lie in [low, high]. NaN is not whole.
bool wholeWithin(const ColumnSample& sample, double low, double high);
/// Returns true if all finite numbers of a sample are whole.
bool isWhole(const ColumnSample& sample);
/// Returns the smallest and the largest finite number; 0 and 0 if there is none.
struct Extent {
  double low = 0.0, high = 0.0;
};
Extent extentOf(const ColumnSample& sample);

/// Returns true if three columns hold unit vectors. Zero vectors and NaN are allowed beside them.
bool areNormals(const std::vector<ColumnSample>& samples, std::size_t first);
/// Returns true if three columns hold colours as whole numbers from 0 to 255.
bool areColours(const std::vector<ColumnSample>& samples, std::size_t first);
/// Returns true if three columns hold colours as fractions from 0 to 1.
bool areColourFractions(const std::vector<ColumnSample>& samples, std::size_t first);

}  // namespace gaussmap::detail
