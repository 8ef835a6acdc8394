// SPDX-License-Identifier: BSD-3-Clause
// gaussmap draw: ellipses with known answers, read back from the picture.
#include <cmath>
#include <regex>

#include "apps/app_fixture.h"
#include "gaussmap/io/gmap/map_file.h"
#include "gaussmap/mapping/build.h"

namespace gaussmap::test {
namespace {

const double kPi = std::acos(-1.0);

/// An ellipse of the picture [pixels, degree], in the order of drawing.
struct Drawn {
  double x, y, rx, ry, angle;
  std::string colour;
};

std::vector<Drawn> ellipsesOf(const std::string& svg) {
  static const std::regex pattern(
      "<ellipse cx='([^']+)' cy='([^']+)' rx='([^']+)' ry='([^']+)' transform='rotate\\(([^ ]+) [^']*' "
      "color='([^']+)'");
  std::vector<Drawn> ellipses;
  for (std::sregex_iterator match(svg.begin(), svg.end(), pattern), end; match != end; ++match) {
    const auto number = [&](std::size_t group) { return std::stod((*match)[group]); };
    ellipses.push_back({number(1), number(2), number(3), number(4), number(5), (*match)[6]});
  }
  return ellipses;
}

double numberAfter(const std::string& svg, const std::string& text) {
  const std::size_t place = svg.find(text);
  return place == std::string::npos ? std::nan("") : std::stod(svg.substr(place + text.size()));
}

/// Pixels per metre in a picture of a window of this width.
double scaleOf(const std::string& svg, double metres) {
  return numberAfter(svg, "<clipPath id='window'><rect width='") / metres;
}

/// A rotation about z, then a covariance with half axes 3, 1 and 0.5 m in x, y, z, then sheared so that z depends on x:
/// its marginal of x and y does not change.
Gaussian<3> turnedGaussian(const Vector<3>& mean, double degrees) {
  const double angle = degrees * kPi / 180.0;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity(), shear = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  shear(2, 0) = 0.7;
  const Eigen::Matrix3d root = turn * shear * Eigen::Vector3d(3.0, 1.0, 0.5).asDiagonal();
  return {mean, root * root.transpose(), 10.0};
}

class DrawApp : public AppTest {
 protected:
  /// A map of one scale with cells of 10 m; means about the centres of the cells.
  std::string save(const std::string& name, const std::vector<CellKey<3>>& keys,
                   const std::vector<Gaussian<3>>& gaussians) const {
    MapScale<3> scale;
    scale.keys = keys;
    scale.gaussians = gaussians;
    gaussmap::save(own(name), build<3>(scale, {10.0, 2, 1, 0.0}), {}, {true, 3, 0});
    return own(name);
  }
  std::string draw(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"draw", "-o", own("picture.svg"), "--force"});
    succeed(arguments);
    return contentsOf(own("picture.svg"));
  }
};

TEST_F(DrawApp, DrawsTheEllipseOfTheMarginalAtTwoSigma) {
  const std::string map = save("one.gmap", {{0, 0, 0}}, {turnedGaussian({1.0, -2.0, 0.0}, 30.0)});
  const std::string svg = draw({map, "--box", "-10", "-10", "20", "10"});
  const double scale = scaleOf(svg, 30.0);
  ASSERT_GT(scale, 10.0);
  const std::vector<Drawn> ellipses = ellipsesOf(svg);
  ASSERT_EQ(ellipses.size(), 1u);
  EXPECT_NEAR(ellipses[0].x, (6.0 + 10.0) * scale, 0.01);  // the mean is 6 3 5 in the map
  EXPECT_NEAR(ellipses[0].y, (10.0 - 3.0) * scale, 0.01);  // y points down
  EXPECT_NEAR(ellipses[0].rx, 6.0 * scale, 0.01);
  EXPECT_NEAR(ellipses[0].ry, 2.0 * scale, 0.01);
  EXPECT_NEAR(std::remainder(ellipses[0].angle + 30.0, 180.0), 0.0, 0.001);
  EXPECT_NE(svg.find(">one.gmap: scale 0 (10 m), 1 Gaussians<"), std::string::npos) << svg;

  const std::vector<Drawn> at_one = ellipsesOf(draw({map, "--box", "-10", "-10", "20", "10", "--sigma", "1"}));
  EXPECT_NEAR(at_one.at(0).rx, 3.0 * scale, 0.01);
  EXPECT_NEAR(at_one.at(0).ry, 1.0 * scale, 0.01);
}

TEST_F(DrawApp, ShowsAllOfEveryEllipseUnlessABoxIsGiven) {
  const std::string map = save("one.gmap", {{0, 0, 0}}, {turnedGaussian({1.0, -2.0, 0.0}, 30.0)});
  const std::string svg = draw({map});
  const Eigen::Vector2d reach(2 * std::hypot(3 * std::cos(kPi / 6), std::sin(kPi / 6)),
                              2 * std::hypot(3 * std::sin(kPi / 6), std::cos(kPi / 6)));
  const double scale = scaleOf(svg, 2 * reach.x());
  const Drawn ellipse = ellipsesOf(svg).at(0);
  EXPECT_NEAR(ellipse.rx, 6.0 * scale, 0.01);
  EXPECT_NEAR(ellipse.x, reach.x() * scale, 0.01);
  EXPECT_NEAR(ellipse.y, reach.y() * scale, 0.01);
}

TEST_F(DrawApp, HasAScaleBarAsLongAsItSays) {
  const std::string map = save("one.gmap", {{0, 0, 0}}, {turnedGaussian({1.0, -2.0, 0.0}, 30.0)});
  for (const std::string half : {"7", "60", "900", "40000"}) {
    const std::string svg = draw({map, "--box", "-" + half, "-" + half, half, half});
    std::smatch match;
    ASSERT_TRUE(std::regex_search(svg, match, std::regex("v6h([0-9.]+)v-6[^>]*>\n<text[^>]*>([0-9.]+) m<"))) << svg;
    EXPECT_NEAR(std::stod(match[1]) / scaleOf(svg, 2 * std::stod(half)) / std::stod(match[2]), 1.0, 1e-4);
  }
}

TEST_F(DrawApp, PutsSmallEllipsesOnLargeOnesAndColoursThemByTheirTop) {
  Gaussian<3> ground{{0, 0, -4}, Eigen::Vector3d(4, 4, 0.01).asDiagonal(), 1.0},
      pole{{0, 0, -1.8}, Eigen::Vector3d(0.01, 0.01, 1).asDiagonal(), 1.0},
      roof{{0, 0, 4}, Eigen::Vector3d(1, 1, 0.01).asDiagonal(), 1.0};
  const std::string svg =
      draw({save("a.gmap", {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {pole, ground, roof}), "--box", "0", "0", "30", "10"});
  const std::vector<Drawn> ellipses = ellipsesOf(svg);
  ASSERT_EQ(ellipses.size(), 3u);
  EXPECT_GT(ellipses[0].rx, ellipses[1].rx);
  EXPECT_GT(ellipses[1].rx, ellipses[2].rx);
  EXPECT_EQ(ellipses[0].colour, "#fde725");  // the ends of the colours: tops at 1.2 m and 9.2 m
  EXPECT_EQ(ellipses[1].colour, "#440154");
  EXPECT_EQ(ellipses[2].colour, "#21918c");  // 5.2 m, the middle
}

TEST_F(DrawApp, PutsMapsIntoPanelsOfOneScale) {
  const Gaussian<3> gaussian = turnedGaussian({0, 0, 0}, 0.0);
  const std::string a = save("a.gmap", {{0, 0, 0}}, {gaussian}),
                    b = save("b<&>.gmap", {{0, 0, 0}, {1, 0, 0}}, {gaussian, gaussian});
  const std::string svg = draw({a, b});
  const std::vector<Drawn> ellipses = ellipsesOf(svg);
  ASSERT_EQ(ellipses.size(), 3u);
  EXPECT_EQ(ellipses[0].x, ellipses[1].x);
  EXPECT_EQ(ellipses[0].rx, ellipses[2].rx);
  EXPECT_NEAR(ellipses[2].x - ellipses[1].x, 10.0 * ellipses[0].rx / 6.0, 0.01);
  EXPECT_NE(svg.find(">b&lt;&amp;&gt;.gmap: scale 0 (10 m), 2 Gaussians<"), std::string::npos) << svg;
  const std::string odd = save("gr\xfc\xdf.gmap", {{0, 0, 0}}, {gaussian});  // no UTF-8
  EXPECT_EQ(draw({odd}).find('\xfc'), std::string::npos);
}

TEST_F(DrawApp, LosesNothingFarFromTheOrigin) {
  const Gaussian<3> gaussian = turnedGaussian({0, 0, 0}, 50.0);
  const std::vector<Drawn> near = ellipsesOf(draw({save("near.gmap", {{0, 0, 0}}, {gaussian})})),
                           far = ellipsesOf(draw({save("far.gmap", {{1000000, -1000000, 0}}, {gaussian})}));
  EXPECT_NEAR(near.at(0).x, far.at(0).x, 0.01);
  EXPECT_NEAR(near.at(0).y, far.at(0).y, 0.01);
  EXPECT_NEAR(near.at(0).rx, far.at(0).rx, 0.01);
}

TEST_F(DrawApp, RefusesMoreThanAViewerShowsAndNamesTheWayOut) {
  std::vector<Vector<3>> points;
  for (int x = 0; x < 460; ++x)
    for (int y = 0; y < 440; ++y) points.emplace_back(x + 0.5, y + 0.5, 0.5);
  gaussmap::save(own("large.gmap"), build<3>(points, {1.0, 10, 2, 0.0}));
  expectUsageError("--box", {"draw", own("large.gmap"), "-o", own("x.svg"), "--scale", "0"});
  expectUsageError("202400 Gaussians", {"draw", own("large.gmap"), "-o", own("x.svg"), "--scale", "0"});
  EXPECT_EQ(ellipsesOf(draw({own("large.gmap"), "--scale", "0", "--box", "10", "10", "13", "12"})).size(), 6u);
  EXPECT_EQ(ellipsesOf(draw({own("large.gmap")})).size(), 46u * 44u);  // the coarsest scale
}

TEST_F(DrawApp, RefusesWhatItCannotDraw) {
  const std::string map = save("one.gmap", {{0, 0, 0}}, {turnedGaussian({0, 0, 0}, 0.0)});
  gaussmap::save(own("empty.gmap"), GaussianMapOctree({1.0, 2, 1, 0.0}));
  const std::string svg = own("x.svg");
  expectUsageError(".svg", {"draw", map, "-o", own("x.png")});
  expectUsageError("--scale", {"draw", map, "-o", svg, "--scale", "1"});
  expectUsageError("--box", {"draw", map, "-o", svg, "--box", "3", "0", "3", "1"});
  expectUsageError("--box", {"draw", map, "-o", svg, "--box", "0", "2", "3", "1"});
  expectUsageError("--box", {"draw", map, "-o", svg, "--box", "0", "0", "nan", "1"});
  expectUsageError("--box", {"draw", map, "-o", svg, "--box", "0", "0", "1"});
  expectUsageError("--sigma", {"draw", map, "-o", svg, "--sigma", "0"});
  expectUsageError("maps", {"draw", "-o", svg});
  expectDataError("no Gaussian", {"draw", map, "-o", svg, "--box", "100", "100", "101", "101"});
  expectDataError("no Gaussian", {"draw", own("empty.gmap"), "-o", svg});
  expectDataError(own("no.gmap") + ": ", {"draw", own("no.gmap"), "-o", svg});
  directory_.write("mine.svg", "mine");
  expectUsageError("--force", {"draw", map, "-o", own("mine.svg")});
  EXPECT_EQ(contentsOf(own("mine.svg")), "mine");
}

}  // namespace
}  // namespace gaussmap::test
