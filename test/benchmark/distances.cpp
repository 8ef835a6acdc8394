// SPDX-License-Identifier: BSD-3-Clause
#include <pcl/kdtree/kdtree_flann.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "gaussmap/evaluation/hausdorff.h"
#include "measure.h"
#include "parts.h"
#include "street_points.h"

namespace gaussmap::benchmark {
namespace {

double farthest(const Cloud& from, const Cloud::Ptr& to) {
  pcl::KdTreeFLANN<pcl::PointXYZ> tree(false);
  tree.setInputCloud(to);
  pcl::Indices index(1);
  std::vector<float> squared(1);
  float most = 0.0f;
  for (const pcl::PointXYZ& point : from) {
    tree.nearestKSearch(point, 1, index, squared);
    most = std::max(most, squared.front());
  }
  return std::sqrt(static_cast<double>(most));
}

}  // namespace

void measureHausdorff(std::size_t points, int runs, Table& table) {
  const std::pair<const char*, std::uint64_t> others[] = {{"same places, other noise", 80},
                                                          {"the next metres of the drive", 9}};
  const Cloud::Ptr a = cloudOf(streetPoints(points, 0, 1));
  for (const auto& [name, first_scan] : others) {
    const Cloud::Ptr b = cloudOf(streetPoints(points, first_scan, 1));
    // PCL stores floats: both methods get the same rounded points.
    const auto doubles = [](const Cloud& cloud) {
      std::vector<Vector<3>> all;
      for (const pcl::PointXYZ& p : cloud) all.emplace_back(p.x, p.y, p.z);
      return all;
    };
    const std::vector<Vector<3>> da = doubles(*a), db = doubles(*b);
    const auto ours = [&](int threads) { return [&, threads] { return hausdorff(da, db, threads).hausdorff(); }; };
    const std::vector<Measured> of =
        measureInTurn({ours(1), ours(2), [&] { return hausdorffMaxima(da, db, 1).hausdorff(); },
                       [&, ca = a, cb = b] { return std::max(farthest(*ca, cb), farthest(*cb, ca)); }},
                      runs);
    for (const Measured& one : of)
      if (std::abs(one.value - of[0].value) > 1e-4 * of[0].value)
        throw std::runtime_error("the Hausdorff distances differ");
    const auto row = [&](const char* part, int threads, const Measured& measured) {
      table.add(Row{part, name, threads, measured.seconds, measured.megabytes, "pcl::KdTreeFLANN", of[3].seconds,
                    of[3].megabytes});
    };
    row("Hausdorff, all figures", 1, of[0]);
    row("Hausdorff, all figures", 2, of[1]);
    row("Hausdorff, the maxima", 1, of[2]);
  }
}

}  // namespace gaussmap::benchmark
