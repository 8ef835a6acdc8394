// SPDX-License-Identifier: BSD-3-Clause
// Error curves, MaxError and MaxBytes of planar maps.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "gaussmap/io/gmap/map_file.h"
#include "gaussmap/map/sampling.h"
#include "gaussmap/mapping/build.h"
#include "gaussmap/mapping/refine.h"
#include "map/random_clouds.h"

namespace gaussmap {
namespace {

GaussianMap<2> planarCloudMap() {
  return build<2>(test::randomCloud<2>(4000, 21), {0.05, 5, 3, 0.0});
}

ErrorSampling fewPlanarSamples() {
  ErrorSampling sampling;
  sampling.samples = 1500;
  sampling.data = 4000;
  return sampling;
}

/// The 95 % quantile of the distances from samples of a scale to samples of the finest scale, by all pairs.
double errorByAllPairs(const GaussianMap<2>& map, int s, const ErrorSampling& sampling) {
  const std::vector<Vector<2>> data = sampleMap<2>(map, 0, {sampling.data, 1, SampleShare::Mass, sampling.seed}).points;
  std::vector<double> errors;
  for (const Vector<2>& sample :
       sampleMap<2>(map, s, {sampling.samples, 1, SampleShare::Volume, sampling.seed}).points) {
    double square = std::numeric_limits<double>::infinity();
    for (const Vector<2>& point : data) square = std::min(square, (point - sample).squaredNorm());
    errors.push_back(std::sqrt(square));
  }
  std::sort(errors.begin(), errors.end());
  return errors[static_cast<std::size_t>(std::ceil(0.95 * double(errors.size()))) - 1];
}

TEST(PlanarBudget, CurvesHoldTheErrorOfTheRefinedMap) {
  RefineOptions options;
  options.curves = CurveOptions{{1.0, 2.0, 4.0}, fewPlanarSamples()};
  const GaussianMap<2> map = planarCloudMap();
  const RefineResult<2> refined = refine(map, PerCell{2.0}, options);
  ASSERT_EQ(refined.curves.size(), 2u);
  for (const ErrorCurve& curve : refined.curves) {
    ASSERT_GE(curve.points.size(), 2u);
    EXPECT_EQ(curve.points[0].gaussians, map.cellCount(curve.scale));
    EXPECT_LT(curve.points.back().q95, curve.points.front().q95);
    EXPECT_EQ(curve.points[1].gaussians, refined.map.gaussianCount(curve.scale));
    // refine() draws other samples of the same Gaussians
    EXPECT_NEAR(curve.points[1].q95, errorByAllPairs(refined.map, curve.scale, fewPlanarSamples()),
                0.06 * curve.points[1].q95);
  }
  EXPECT_EQ(refine(map, PerCell{2.0}).map.gaussianCount(1), refined.map.gaussianCount(1));
}

TEST(PlanarBudget, MaxErrorIsKept) {
  const GaussianMap<2> map = planarCloudMap();
  const RefineResult<2> refined = refine(map, MaxError{0.06, fewPlanarSamples()});
  for (int s = 1; s < 3; ++s) {
    const bool listed = std::any_of(refined.not_reached.begin(), refined.not_reached.end(),
                                    [&](const NotReached& one) { return one.scale == s; });
    EXPECT_EQ(errorByAllPairs(refined.map, s, fewPlanarSamples()) > 1.06 * 0.06, listed) << s;
  }
  EXPECT_GT(refined.map.gaussianCount(1), map.cellCount(1));
  EXPECT_LT(refined.map.gaussianCount(1), map.gaussianCount(0));
}

TEST(PlanarBudget, MaxBytesIsKeptAndUsed) {
  const GaussianMap<2> map = planarCloudMap();
  RefineOptions options;
  options.curves = CurveOptions{{1.0, 2.0}, fewPlanarSamples()};
  const std::uintmax_t least = savedSize(refine(map, PerCell{1.0}, options)),
                       more = savedSize(refine(map, PerCell{3.0}, options)), most = (least + more) / 2;
  const RefineResult<2> refined = refine(map, maxFileBytes(most), options);
  EXPECT_LE(savedSize(refined), most);
  EXPECT_GT(savedSize(refined), least);
  EXPECT_EQ(refined.curves.size(), 2u);
  EXPECT_THROW(refine(map, maxFileBytes(1000)), std::invalid_argument);
}

TEST(PlanarBudget, NamesTheFunctionThatIsMissing) {
  const MaxBytes for_space{100000, [](const RefineResult<3>&) -> std::uintmax_t { return 1; }};
  try {
    refine(planarCloudMap(), for_space);
    ADD_FAILURE() << "there is no function for planar maps";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("planar_size_of"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace gaussmap
