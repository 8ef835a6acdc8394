// SPDX-License-Identifier: BSD-3-Clause
// PCL's templates link for PointGaussian if its header comes after those of PCL.
#include "pcl/headers_of_pcl.h"

#include "gaussmap/pcl/point_gaussian.h"

#include "pcl/templates_of_gaussians.h"

// After them, so that it brings no header of PCL's.
#include <gtest/gtest.h>

#ifdef PCL_NO_PRECOMPILE
#error "a header defines PCL_NO_PRECOMPILE"
#endif

TEST(PointGaussian, WorksInTemplatesOfPclIfItsHeaderComesLast) {
  EXPECT_EQ(gaussmap::test::useTemplatesOfPcl(), 0);
}
