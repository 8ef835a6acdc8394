// SPDX-License-Identifier: BSD-3-Clause
// All plug-ins beside PCL's own classes, for a user's own point type. PCL's rule for all of its classes is this line
// before its headers.
#define PCL_NO_PRECOMPILE
#include <pcl/registration/icp.h>

#include "pcl/plug_in_situations.h"
#include "pcl/random_surface.h"

namespace gaussmap::test {
namespace {

using Pairs =
    testing::Types<Thinning<RingPoint>, Selection<RingPoint>, Normals<RingPoint>,
                   Registrations<RingPoint, pcl::IterativeClosestPoint>, Building<RingPoint>, OnlineMapping<RingPoint>,
                   Searching<RingPoint>, Clustering<RingPoint>, Segments<RingPoint>>;
INSTANTIATE_TYPED_TEST_SUITE_P(OwnPointType, PlugIn, Pairs, );

}  // namespace
}  // namespace gaussmap::test
