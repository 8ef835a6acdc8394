// SPDX-License-Identifier: BSD-3-Clause
// What the core writes for ParaView, read by VTK's own reader.
#include <gtest/gtest.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataReader.h>

#include <cmath>

#include "gaussmap/io/export/map_export.h"
#include "gaussmap/mapping/build.h"
#include "io/files/temporary_directory.h"
#include "map/random_clouds.h"

namespace gaussmap::test {
namespace {

class GaussianVtp : public testing::Test {
 protected:
  vtkPolyData* read(const GaussianMap<3>& map, std::optional<int> scale) {
    const std::filesystem::path path = directory_.path() / "map.vtp";
    count_ = saveVtp(path, map, scale);
    reader_->SetFileName(path.c_str());
    reader_->Modified();  // another file of the same name
    reader_->Update();
    EXPECT_EQ(reader_->GetErrorCode(), 0u);
    return reader_->GetOutput();
  }
  TemporaryDirectory directory_;
  vtkNew<vtkXMLPolyDataReader> reader_;
  std::size_t count_ = 0;
};

Matrix<3> tensorOf(vtkDataArray* array, vtkIdType i) {
  double values[9];
  array->GetTuple(i, values);
  return Eigen::Map<const Eigen::Matrix3d>(values);
}

TEST_F(GaussianVtp, HoldsEveryGaussianOfAllScalesToTheLastBitAlsoFarAway) {
  std::vector<Vector<3>> points = randomCloud<3>(1000, 4);
  for (Vector<3>& point : points) point += Vector<3>(1e7, -1e7, 5.0);
  const GaussianMap<3> map = build<3>(points, {0.25, 4, 3, 0.0});
  vtkPolyData* const data = read(map, {});
  ASSERT_EQ(data->GetNumberOfPoints(), vtkIdType(count_));
  ASSERT_EQ(data->GetNumberOfVerts(), vtkIdType(count_));
  vtkPointData& arrays = *data->GetPointData();
  ASSERT_EQ(arrays.GetNumberOfArrays(), 9);
  EXPECT_STREQ(arrays.GetTensors()->GetName(), "deviation");
  EXPECT_STREQ(arrays.GetNormals()->GetName(), "normal");
  EXPECT_STREQ(arrays.GetScalars()->GetName(), "weight");
  vtkIdType row = 0;
  std::vector<vtkIdType> first(3);
  for (int s = 2; s >= 0; --s) {
    first[std::size_t(s)] = row;
    for (std::size_t i = 0; i < map.gaussianCount(s); ++i, ++row) {
      const Gaussian<3> gaussian = map.gaussian(i, s);
      double place[3];
      data->GetPoint(row, place);
      EXPECT_EQ(Vector<3>(place[0], place[1], place[2]), gaussian.mean);
      EXPECT_EQ(tensorOf(arrays.GetArray("covariance"), row), gaussian.cov);
      const Matrix<3> root = tensorOf(arrays.GetArray("deviation"), row);
      EXPECT_LT((root * root - gaussian.cov).norm(), 1e-12 * gaussian.cov.norm());
      EXPECT_EQ(arrays.GetArray("weight")->GetTuple1(row), gaussian.weight);
      EXPECT_EQ(arrays.GetArray("scale")->GetTuple1(row), s);
      EXPECT_EQ(arrays.GetArray("cell_side")->GetTuple1(row), map.grid().side(s));
      EXPECT_EQ(arrays.GetArray("log_odds")->GetTuple1(row), 10.0);
      EXPECT_NEAR(arrays.GetArray("occupancy")->GetTuple1(row), 1.0 / (1.0 + std::exp(-10.0)), 1e-6);
      EXPECT_EQ(arrays.GetArray("parent")->GetTuple1(row),
                s == 2 ? -1.0 : double(first[std::size_t(s) + 1]) + double(map.parentOf(i, s)));
      double normal[3];
      arrays.GetNormals()->GetTuple(row, normal);
      const Vector<3> n(normal[0], normal[1], normal[2]);
      EXPECT_LE(n.dot(gaussian.cov * n), gaussian.cov.trace() / 3.0);
    }
  }
}

TEST_F(GaussianVtp, CanBeOneScaleWithoutParentsOrAnEmptyMap) {
  const GaussianMap<3> map = build<3>(randomCloud<3>(300, 4), {0.25, 4, 2, 0.0});
  vtkPolyData* data = read(map, 0);
  ASSERT_EQ(data->GetNumberOfPoints(), vtkIdType(map.gaussianCount(0)));
  EXPECT_EQ(data->GetPointData()->GetArray("parent")->GetRange()[1], -1.0);
  data = read(GaussianMap<3>({1.0, 2, 1, 0.0}), {});
  EXPECT_EQ(data->GetNumberOfPoints(), 0);
}

}  // namespace
}  // namespace gaussmap::test
