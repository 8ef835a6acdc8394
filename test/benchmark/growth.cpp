// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/QR>
#include <cstdio>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/map/moment_grid.h"
#include "gaussmap/mapping/build.h"
#include "measure.h"
#include "parts.h"
#include "street_points.h"

namespace gaussmap::benchmark {
namespace {

/// Spreads the drive over a square kilometre: 25 blocks, 200 m apart.
Cloud::Ptr spread(const Cloud& drive) {
  Cloud::Ptr wide(new Cloud(drive));
  for (std::size_t i = 0; i < wide->size(); ++i) {
    const std::size_t block = i * 25 / wide->size();
    (*wide)[i].x += 200.0f * static_cast<float>(block % 5);
    (*wide)[i].y += 200.0f * static_cast<float>(block / 5);
  }
  return wide;
}

/// The fit values ~ a x + b y by least squares of the relative errors; `worst` = the largest relative error of the fit.
struct Fit {
  double a = 0.0, b = 0.0, worst = 0.0;
};

Fit fit(const std::vector<double>& x, const std::vector<double>& y, const std::vector<double>& values) {
  Eigen::MatrixXd rows(x.size(), 2);
  for (std::size_t i = 0; i < x.size(); ++i)
    rows.row(static_cast<Eigen::Index>(i)) << x[i] / values[i], y[i] / values[i];
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(rows.rows());
  const Eigen::Vector2d both = rows.colPivHouseholderQr().solve(ones);
  return {both[0], both[1], (rows * both - ones).cwiseAbs().maxCoeff()};
}

void grow(const char* name, const std::vector<std::size_t>& counts, bool is_wide, Table& table) {
  std::vector<double> points, cells, seconds, megabytes;
  for (const std::size_t count : counts) {
    Cloud::Ptr cloud = cloudOf(streetPoints(count, 0, 1));
    if (is_wide) cloud = spread(*cloud);
    const auto work = [&] {
      const MomentGrid<3> sums =
          countPoints(0.2, {(*cloud)[0].data, cloud->size(), sizeof(pcl::PointXYZ) / sizeof(float)}, 1);
      return static_cast<double>(build<3>(sums, {0.2, 5, 3, 0.0}).cellCount(0));
    };
    const Measured measured = measureInTurn({work}, 3).front();
    std::printf("growth, %s: %zu points, %.0f cells, %.3f s, %.1f ns per point, %.1f MB, %.0f bytes per cell\n", name,
                count, measured.value, measured.seconds, 1e9 * measured.seconds / static_cast<double>(count),
                measured.megabytes, measured.megabytes * 1048576.0 / measured.value);
    std::fflush(stdout);
    points.push_back(static_cast<double>(count));
    cells.push_back(measured.value);
    seconds.push_back(measured.seconds);
    megabytes.push_back(measured.megabytes);
  }
  if (counts.size() < 3) return;
  const Fit time = fit(points, cells, seconds);
  table.add(Figure{"growth, time", name, "per point", "ns", 1e9 * time.a});
  table.add(Figure{"growth, time", name, "per cell", "ns", 1e9 * time.b});
  table.add(Figure{"growth, time", name, "largest deviation from the fit", "%", 100.0 * time.worst});
  const Fit memory = fit(cells, std::vector<double>(cells.size(), 1.0), megabytes);
  table.add(Figure{"growth, memory", name, "per cell", "bytes", 1048576.0 * memory.a});
  table.add(Figure{"growth, memory", name, "constant", "MB", memory.b});
  table.add(Figure{"growth, memory", name, "largest deviation from the fit", "%", 100.0 * memory.worst});
}

}  // namespace

void measureGrowth(const std::vector<std::size_t>& points, Table& table) {
  grow("one drive of 160 m, repeated", points, false, table);
  grow("a square kilometre", points, true, table);
}

}  // namespace gaussmap::benchmark
