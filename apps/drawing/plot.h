// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/mapping/refine.h"

namespace gaussmap::app {

enum class AxisScale {
  Linear,      ///< the axis begins at 0
  Logarithmic  ///< the axis begins and ends at powers of ten; smaller values than 1e-9 are drawn as 1e-9
};

/// An axis of a plot. Its range follows from the points.
struct PlotAxis {
  std::string title;  ///< quantity and unit
  AxisScale scale = AxisScale::Linear;
};

/// A line of a plot.
struct PlotLine {
  std::string name;               ///< its entry in the legend; empty: no entry
  std::vector<Vector<2>> points;  ///< finite; not negative
  int colour = 0;                 ///< lines of one number have one colour
  bool dashed = false;
};

/// Lines over one pair of axes.
struct LinePlot {
  PlotAxis x, y;
  std::vector<PlotLine> lines;
};

/// Writes a plot as SVG, with the legend on its right. At least one line must have a point. Throws FileError if the
/// file cannot be written.
void drawPlot(const LinePlot& plot, const std::filesystem::path& path);

/// Draws error curves as SVG: the number of Gaussians on the x axis, 95 % and mean error on the y axis, both
/// logarithmic. At least one curve must have a point. Throws FileError if the file cannot be written.
void plotCurves(const std::vector<ErrorCurve>& curves, const std::filesystem::path& path);

}  // namespace gaussmap::app
