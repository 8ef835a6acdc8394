// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdio>

#include "gaussmap/gaussian/random.h"
#include "gaussmap/map/count_points.h"
#include "gaussmap/mapping/build.h"
#include "measure.h"
#include "parts.h"
#include "street_scene.h"

namespace gaussmap::benchmark {
namespace {

/// 25 blocks of the drive, 200 m apart: a square kilometre.
Cloud::Ptr spread(const Cloud& drive) {
  Cloud::Ptr wide(new Cloud(drive));
  for (std::size_t i = 0; i < wide->size(); ++i) {
    const std::size_t block = i * 25 / wide->size();
    (*wide)[i].x += 200.0f * static_cast<float>(block % 5);
    (*wide)[i].y += 200.0f * static_cast<float>(block / 5);
  }
  return wide;
}

/// The slope of log y over log x: 1 = linear.
double exponent(const std::vector<double>& x, const std::vector<double>& y) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  const auto n = static_cast<double>(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double a = std::log(x[i]), b = std::log(y[i]);
    sx += a, sy += b, sxx += a * a, sxy += a * b;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

void grow(const char* name, const std::vector<std::size_t>& counts, bool is_wide, Table& table) {
  std::vector<double> points, cells, seconds, megabytes;
  for (const std::size_t count : counts) {
    Cloud::Ptr cloud = cloudOf(benchmark_input::streetPoints(count, 0, 1));
    if (is_wide) cloud = spread(*cloud);
    const auto work = [&] {
      const MomentGrid<3> sums = countPoints<3>(
          0.2, cloud->size(), [&](std::size_t i) { return (*cloud)[i].data; }, 1);
      return static_cast<double>(build<3>(sums, {0.2, 5, 3, 0.0}).cellCount(0));
    };
    const Measured measured = measureInTurn({work}, 3).front();
    std::printf("growth, %s: %zu points, %.0f cells, %.3f s, %.1f ns a point, %.1f MB, %.0f bytes a cell\n", name,
                count, measured.value, measured.seconds, 1e9 * measured.seconds / static_cast<double>(count),
                measured.megabytes, measured.megabytes * 1048576.0 / measured.value);
    std::fflush(stdout);
    points.push_back(static_cast<double>(count));
    cells.push_back(measured.value);
    seconds.push_back(measured.seconds);
    megabytes.push_back(measured.megabytes);
  }
  if (counts.size() < 2) return;
  table.add(Figure{"growth", name, "time ~ points to the power of", "", exponent(points, seconds), 0.0});
  table.add(Figure{"growth", name, "memory ~ cells to the power of", "", exponent(cells, megabytes), 0.0});
}

}  // namespace

void measureGrowth(const std::vector<std::size_t>& points, Table& table) {
  grow("one drive of 160 m, again and again", points, false, table);
  grow("a square kilometre", points, true, table);
}

}  // namespace gaussmap::benchmark
