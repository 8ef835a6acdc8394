// SPDX-License-Identifier: BSD-3-Clause
// All plug-ins beside PCL's own classes, for a point type of PCL. A new plug-in gets a line here and in
// plug_ins_own_point_test.cpp.
#include <pcl/registration/ndt.h>

#include "pcl/plug_in_situations.h"

namespace gaussmap::test {
namespace {

template <typename Source, typename Target, typename Scalar>
class Ndt : public pcl::NormalDistributionsTransform<Source, Target> {
 public:
  static_assert(std::is_same_v<Scalar, float>);
};

using Pairs = testing::Types<Thinning<pcl::PointXYZ>, Selection<pcl::PointXYZ>, Normals<pcl::PointXYZ>,
                             Registrations<pcl::PointXYZ, Ndt>, Building<pcl::PointXYZ>, OnlineMapping<pcl::PointXYZ>,
                             Searching<pcl::PointXYZ>, Clustering<pcl::PointXYZ>, Segments<pcl::PointXYZ>>;
INSTANTIATE_TYPED_TEST_SUITE_P(PointTypeOfPcl, PlugIn, Pairs, );

}  // namespace
}  // namespace gaussmap::test
