// SPDX-License-Identifier: BSD-3-Clause
// Pictures with known answers, drawn off screen.
#include "viewer/viewer.h"

#include <gtest/gtest.h>
#include <vtkActorCollection.h>
#include <vtkDataArray.h>
#include <vtkDataSet.h>
#include <vtkMapper.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include <cmath>
#include <set>

#include "gaussmap/mapping/build.h"
#include "map/random_clouds.h"
#include "viewer/viewer_parts.h"

namespace gaussmap::test {
using namespace detail;

namespace {

/// One Gaussian, deviations 3, 1 and 0.5 m, the longest axis turned by `angle` from x to y.
GaussianMap<3> oneGaussian(double angle, const Vector<3>& far = Vector<3>::Zero()) {
  Matrix<3> turn = Matrix<3>::Identity();
  turn.topLeftCorner<2, 2>() << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  const Matrix<3> root = turn * Vector<3>(3.0, 1.0, 0.5).asDiagonal();
  MapScale<3> scale;
  scale.keys = {{static_cast<int>(far.x() / 20.0), static_cast<int>(far.y() / 20.0), 0}};
  scale.gaussians = {{Vector<3>::Zero(), root * root.transpose(), 10.0}};
  return GaussianMap<3>({20.0, 2, 1, 0.0}, {scale});
}

/// The spread of the pixels of an ellipse around the middle of the picture.
struct Spread {
  double xx = 0, xy = 0, yy = 0, count = 0;
  double long_axis() const { return 2.0 * std::sqrt(0.5 * (xx + yy) + std::hypot(0.5 * (xx - yy), xy)); }
  double short_axis() const { return 2.0 * std::sqrt(0.5 * (xx + yy) - std::hypot(0.5 * (xx - yy), xy)); }
  double angle() const { return 0.5 * std::atan2(2.0 * xy, xx - yy); }
};

/// Of what has a colour in the middle part of a picture, where no text is; the background is almost grey.
Spread spreadOf(const Picture& picture) {
  Spread spread;
  for (int y = picture.height / 8; y < picture.height * 7 / 8; ++y)
    for (int x = picture.width / 8; x < picture.width * 7 / 8; ++x) {
      const auto& pixel = picture.pixels[static_cast<std::size_t>(y * picture.width + x)];
      if (std::abs(pixel[0] - pixel[2]) < 40) continue;
      const double dx = x + 0.5 - 0.5 * picture.width, dy = 0.5 * picture.height - (y + 0.5);
      spread.xx += dx * dx;
      spread.xy += dx * dy;
      spread.yy += dy * dy;
      spread.count += 1.0;
    }
  spread.xx /= spread.count;
  spread.xy /= spread.count;
  spread.yy /= spread.count;
  return spread;
}

ViewOptions fromAbove() {
  ViewOptions options;
  options.scale = 0;
  options.colour = ColourBy::Scale;
  options.view = viewFromAbove(Vector<3>::UnitZ());
  options.view.zoom = 0.01;  // a single mean is framed closely
  return options;
}

TEST(Viewer, DrawsTheEllipseOfTheGaussianItIsGiven) {
  for (const double angle : {0.0, 0.5, -1.0}) {
    Viewer viewer({"one", oneGaussian(angle), {}}, fromAbove());
    const Spread spread = spreadOf(viewer.picture(800, 800));
    ASSERT_GT(spread.count, 100.0);
    EXPECT_NEAR(spread.long_axis() / spread.short_axis(), 3.0, 0.1);
    EXPECT_NEAR(spread.angle(), angle, 0.02);
  }
}

TEST(Viewer, LosesNothingFarFromTheOrigin) {
  Viewer near({"near", oneGaussian(0.5), {}}, fromAbove());
  Viewer far({"far", oneGaussian(0.5, {1e7, -2e7, 0.0}), {}}, fromAbove());
  const Spread a = spreadOf(near.picture(800, 800)), b = spreadOf(far.picture(800, 800));
  EXPECT_NEAR(a.long_axis(), b.long_axis(), 0.5);
  EXPECT_NEAR(a.angle(), b.angle(), 0.01);
}

TEST(Viewer, KeysChangeSizeScaleColourAndWhatIsShown) {
  Viewer viewer({"cloud", build<3>(randomCloud<3>(3000, 3), {0.1, 3, 3, 0.0}), {{0, 0, 0}}});
  EXPECT_TRUE(viewer.press("2"));
  EXPECT_EQ(viewer.options().scale, 2);
  EXPECT_FALSE(viewer.press("3"));
  EXPECT_TRUE(viewer.press("Up"));
  EXPECT_EQ(viewer.options().scale, 2);
  EXPECT_TRUE(viewer.press("Down"));
  EXPECT_EQ(viewer.options().scale, 1);
  EXPECT_TRUE(viewer.press("l"));
  EXPECT_FALSE(viewer.options().scale);
  EXPECT_TRUE(viewer.press("plus"));
  EXPECT_DOUBLE_EQ(viewer.options().sigma, 2.5);
  EXPECT_TRUE(viewer.press("minus"));
  EXPECT_DOUBLE_EQ(viewer.options().sigma, 2.0);
  EXPECT_FALSE(viewer.press("F7"));
  for (int i = 0; i < kColourings; ++i) EXPECT_TRUE(viewer.press("c"));
  EXPECT_EQ(viewer.options().colour, ColourBy::Height);  // once round
}

TEST(Viewer, EveryKeyShowsInThePicture) {
  ViewOptions options;
  options.scale = 1;
  Viewer viewer({"cloud", build<3>(randomCloud<3>(3000, 3), {0.1, 3, 3, 0.0}), {{0, 0, 0}, {1, 1, 1}}}, options);
  Picture last = viewer.picture(200, 150);
  for (const char* const key : {"plus", "2", "c", "g", "p", "h", "F1", "t"}) {
    ASSERT_TRUE(viewer.press(key));
    const Picture next = viewer.picture(200, 150);
    EXPECT_NE(next.pixels, last.pixels) << key;
    last = next;
  }
}

TEST(Viewer, ShowsSegmentsAsWalls) {
  SegmentMap map;
  Segment wall;
  wall.start = {1e7, 0.0};
  wall.end = {1e7 + 10.0, 0.0};
  map.segments = {wall};
  map.chains = {{0, 1, false}};
  ViewOptions options;
  options.view.zoom = 0.5;
  Viewer viewer({"walls", map, {}}, options);
  EXPECT_GT(spreadOf(viewer.picture(300, 200)).count, 100.0);
  EXPECT_FALSE(viewer.press("2"));
  EXPECT_TRUE(viewer.press("t"));
}

/// A square of 4 m x 2 m at z = 1 m, as two triangles.
TriangleMesh square(const Vector<3>& corner) {
  TriangleMesh mesh;
  mesh.vertices = {corner, corner + Vector<3>(4, 0, 0), corner + Vector<3>(4, 2, 0), corner + Vector<3>(0, 2, 0)};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

/// The number of pixels of a mesh in the middle part of a picture: the background is bluish, meshes are yellowish.
double meshPixels(const Picture& picture) {
  double count = 0.0;
  for (const auto& pixel : picture.pixels) count += pixel[0] > pixel[2] + 5 ? 1.0 : 0.0;
  return count;
}

TEST(Viewer, ShowsAMeshInItsTrueSize) {
  ViewOptions options;
  options.view = viewFromAbove(Vector<3>::UnitZ());
  options.view.span = 5.0;  // 400 pixels are 5 m, so the mesh has 320 x 160 pixels
  for (const Vector<3>& corner : {Vector<3>(1, 2, 1), Vector<3>(1e7, -2e7, 1)}) {
    Viewer viewer({"mesh", square(corner), {}}, options);
    EXPECT_NEAR(meshPixels(viewer.picture(600, 400)), 320.0 * 160.0, 600.0);
    EXPECT_FALSE(viewer.press("2"));
  }
  options.view.span = 10.0;
  Viewer viewer({"mesh", square({1, 2, 1}), {}}, options);
  EXPECT_NEAR(meshPixels(viewer.picture(600, 400)), 160.0 * 80.0, 300.0);
}

TEST(Viewer, ShowsAMeshWithTheMapUntilMIsPressed) {
  ViewOptions options = fromAbove();
  options.view.span = 30.0;
  ViewScene scene{"one", oneGaussian(0.0), {}};
  scene.mesh = square({2, 14, -1});
  Viewer viewer(scene, options);
  const double with_mesh = meshPixels(viewer.picture(400, 400));
  ASSERT_TRUE(viewer.press("m"));
  const double without = meshPixels(viewer.picture(400, 400));
  EXPECT_NEAR(with_mesh - without, 8.0 * std::pow(400.0 / 30.0, 2), 60.0);
}

TEST(Viewer, RefusesWhatItCannotShow) {
  EXPECT_THROW(Viewer({"empty", GaussianMap<3>({1.0, 2, 1, 0.0}), {}}), std::invalid_argument);
  EXPECT_THROW(Viewer({"empty", SegmentMap(), {}}), std::invalid_argument);
  EXPECT_THROW(Viewer({"empty", TriangleMesh(), {}}), std::invalid_argument);
  TriangleMesh broken = square({0, 0, 0});
  broken.triangles[0][0] = 9;
  EXPECT_THROW(Viewer({"broken", broken, {}}), std::invalid_argument);
  EXPECT_THROW(Viewer({"broken", oneGaussian(0.0), {}, broken}), std::invalid_argument);
  const auto refuses = [](auto change) {
    ViewOptions options;
    change(options);
    EXPECT_THROW(Viewer({"one", oneGaussian(0.0), {}}, options), std::invalid_argument);
  };
  refuses([](ViewOptions& options) { options.scale = 1; });
  refuses([](ViewOptions& options) { options.scale = -1; });
  refuses([](ViewOptions& options) { options.sigma = 0.0; });
  refuses([](ViewOptions& options) { options.sigma = std::nan(""); });
  refuses([](ViewOptions& options) { options.view.zoom = -1.0; });
  refuses([](ViewOptions& options) { options.view.span = 0.0; });
  refuses([](ViewOptions& options) { options.view.span = std::nan(""); });
  refuses([](ViewOptions& options) { options.view.direction.setZero(); });
  refuses([](ViewOptions& options) { options.up.setConstant(std::nan("")); });
}

TEST(CentreActor, ShowsAnEvenChoiceOfManyCentresEachInItsColour) {
  std::vector<Glyph> glyphs(120001);
  std::vector<Colour> colours(glyphs.size());
  for (std::size_t i = 0; i < glyphs.size(); ++i) {
    glyphs[i].centre[0] = float(i);
    colours[i] = {static_cast<unsigned char>(i % 251), 0, 0};
  }
  const auto actor = centreActor(glyphs, colours);
  actor->GetMapper()->Update();
  vtkDataSet* const data = actor->GetMapper()->GetInput();
  const vtkIdType count = data->GetNumberOfPoints();
  ASSERT_EQ(count, 40001);  // each third: 60,000 at most
  ASSERT_EQ(data->GetPointData()->GetScalars()->GetNumberOfTuples(), count);
  for (vtkIdType k = 0; k < count; ++k) {
    ASSERT_EQ(data->GetPoint(k)[0], 3.0 * double(k));
    ASSERT_EQ(data->GetPointData()->GetScalars()->GetComponent(k, 0), double(3 * k % 251));
  }
}

TEST(Viewer, LinksAnEvenSelectionOfManyGaussiansToTheirParents) {
  std::vector<Vector<3>> points;  // one per finest cell: 28,000 finest cells, 280 and 4 coarse ones
  for (int x = 0; x < 200; ++x)
    for (int y = 0; y < 140; ++y) points.emplace_back(x + 0.5, y + 0.5, 0.5);
  Viewer::Parts parts;
  parts.scene.map = build<3>(points, {1.0, 10, 3, 0.1});
  parts.options.hierarchy = true;
  parts.build(200, 100);
  std::multiset<vtkIdType> links;  // per pair of scales
  vtkActorCollection* const actors = parts.renderer->GetActors();
  for (actors->InitTraversal(); vtkActor* const actor = actors->GetNextActor();)
    if (auto* const data = vtkPolyData::SafeDownCast(actor->GetMapper()->GetInputDataObject(0, 0)))
      if (data->GetNumberOfLines() > 0) links.insert(data->GetNumberOfLines());
  EXPECT_EQ(links, (std::multiset<vtkIdType>{280, 14000}));  // each second of 28,000: 25,000 at most
}

TEST(Viewer, ShowsTheEllipsoidsInOneDetailAtATime) {
  Viewer::Parts parts;
  parts.scene.map = build<3>(randomCloud<3>(3000, 3), {0.1, 3, 3, 0.0});
  const GaussianMap<3>& map = *parts.map();
  parts.options.hierarchy = true;  // every scale has actors of its own
  parts.build(200, 100);
  const auto visible = [&] {
    std::vector<Detail> details;
    for (const auto& [detail, actors] : parts.ellipsoids)
      for (const auto& actor : actors)
        if (actor->GetVisibility()) details.push_back(detail);
    return details;
  };
  EXPECT_EQ(visible(), std::vector<Detail>(3, Detail::Round));
  parts.setDetail(Detail::FewTriangles);
  EXPECT_EQ(visible(), std::vector<Detail>(3, Detail::FewTriangles));
  parts.setDetail(Detail::Point);
  EXPECT_EQ(visible(), std::vector<Detail>(1, Detail::Point));
  vtkMapper* const mapper = parts.ellipsoids[Detail::Point][0]->GetMapper();
  mapper->Update();
  EXPECT_EQ(std::size_t(mapper->GetInput()->GetNumberOfPoints()),
            map.gaussianCount(0) + map.gaussianCount(1) + map.gaussianCount(2));
  for (const auto& [detail, actors] : parts.ellipsoids)
    for (const auto& actor : actors) EXPECT_TRUE(parts.renderer->HasViewProp(actor));
}

}  // namespace
}  // namespace gaussmap::test
