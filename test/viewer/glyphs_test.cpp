// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/glyphs.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "gaussmap/mapping/build.h"
#include "map/random_clouds.h"

namespace gaussmap::test {
namespace {

/// Where a glyph puts a point of the unit sphere.
Vector<3> placed(const Glyph& glyph, const Vector<3>& point) {
  const Eigen::Quaternionf turn(glyph.rotation[0], glyph.rotation[1], glyph.rotation[2], glyph.rotation[3]);
  const Eigen::Vector3f half(glyph.half_axes[0], glyph.half_axes[1], glyph.half_axes[2]),
      centre(glyph.centre[0], glyph.centre[1], glyph.centre[2]);
  return (centre + turn * half.cwiseProduct(point.cast<float>())).cast<double>();
}

TEST(Glyphs, PutTheUnitSphereAtSigmaStandardDeviationsAlsoFarFromTheOrigin) {
  for (const Vector<3>& shift : {Vector<3>(0, 0, 0), Vector<3>(1e7, -1e7, 0)}) {
    std::vector<Vector<3>> points = randomCloud<3>(1000, 2);
    for (Vector<3>& point : points) point += shift;
    const GaussianMap<3> map = build<3>(points, {0.5, 4, 2, 0.0});
    const Vector<3> origin = middleOf(map);
    const std::vector<Glyph> glyphs = ellipsoidGlyphs(map, gaussiansOfScale(map, 0), 2.0, origin);
    ASSERT_EQ(glyphs.size(), map.gaussianCount(0));
    Random random(5);
    for (std::size_t i = 0; i < glyphs.size(); ++i) {
      Gaussian<3> gaussian = map.gaussian(i, 0);
      gaussian.mean -= origin;
      const Vector<3> direction = GaussianSampler<3>::standard(random).normalized();
      EXPECT_NEAR(mahalanobisSquared<3>(placed(glyphs[i], direction), gaussian), 4.0, 0.01);
      EXPECT_LE(glyphs[i].half_axes[0], glyphs[i].half_axes[2]);
    }
  }
}

TEST(Glyphs, AnEmptyMapHasNoneAndItsMiddleIsZero) {
  const GaussianMap<3> empty({1.0, 2, 1, 0.0});
  EXPECT_TRUE(ellipsoidGlyphs(empty, {}, 2.0, middleOf(empty)).empty());
  EXPECT_EQ(middleOf(empty), Vector<3>::Zero());
}

}  // namespace
}  // namespace gaussmap::test
