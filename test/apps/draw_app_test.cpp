// SPDX-License-Identifier: BSD-3-Clause
// gaussmap draw: ellipses with known answers, read back from the picture.
#include <algorithm>
#include <cmath>
#include <regex>

#include "apps/app_fixture.h"
#include "gaussmap/io/gmap/map_file.h"
#include "gaussmap/mapping/build.h"
#include "gaussmap/mapping/refine.h"

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

/// A filled square of the picture [pixels].
struct Filled {
  double x, y, width, height;
  std::string colour;
};

std::vector<Filled> squaresOf(const std::string& svg) {
  static const std::regex pattern(
      "<rect x='([^']+)' y='([^']+)' width='([^']+)' height='([^']+)' fill='(#[^']+)' fill-opacity='0.7'");
  std::vector<Filled> squares;
  for (std::sregex_iterator match(svg.begin(), svg.end(), pattern), end; match != end; ++match) {
    const auto number = [&](std::size_t group) { return std::stod((*match)[group]); };
    squares.push_back({number(1), number(2), number(3), number(4), (*match)[5]});
  }
  return squares;
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

/// Saves a map with cells of 1 m and 4 m. Over x = 0 to 4 m, the cluster is 1 m from two finer Gaussians, which is 10
/// and 5 of their deviations: error 62.5. Over x = 4 to 8 m, its height is wrong by 0.25 deviations in the lower cell,
/// error 0.0625, and by 2.5 in the upper one, error 6.25.
std::string saveWithErrors(const std::string& path) {
  const auto at = [](double x, double z, double deviation) {
    return Gaussian<3>{{x, 0, z}, deviation * deviation * Matrix<3>::Identity(), 1.0};
  };
  MapScale<3> fine, coarse;
  fine.keys = {{0, 0, 0}, {2, 0, 0}, {5, 0, 0}, {5, 0, 5}};
  fine.gaussians = {at(0, 0, 0.1), at(0, 0, 0.2), at(0, 0, 0.1), at(0, 0, 0.1)};
  fine.parent = {0, 0, 1, 2};
  coarse.keys = {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}};
  coarse.first_child = {0, 2, 3, 4};
  coarse.gaussians = {at(-0.5, -1.5, 1.0), at(-0.5, -1.475, 0.1), at(-0.5, -0.25, 0.1)};
  for (Gaussian<3>& gaussian : coarse.gaussians) gaussian.mean.y() = -1.5;
  gaussmap::save(path, GaussianMap<3>({1.0, 4, 2, 0.0}, {fine, coarse}), {}, {true, 3, 0});
  return path;
}

TEST_F(DrawApp, ColoursFinerGaussiansByTheirContributionToTheErrorOfTheCell) {
  const std::string svg = draw({saveWithErrors(own("map.gmap")), "--color", "contribution"});
  EXPECT_NE(svg.find(">map.gmap: scale 0 (1 m), 4 Gaussians, cells of 4 m<"), std::string::npos) << svg;
  EXPECT_NE(svg.find(">contribution to the error of the coarse cell [squared sigma]<"), std::string::npos);
  const std::vector<Drawn> ellipses = ellipsesOf(svg);  // contributions 25, 100, 0.0625, 6.25: 0.0625 to 100
  ASSERT_EQ(ellipses.size(), 4u);
  EXPECT_EQ(ellipses[1].colour, "#440154");
  EXPECT_EQ(ellipses[2].colour, "#fde725");
  EXPECT_NE(ellipses[0].colour, ellipses[3].colour);
  EXPECT_TRUE(squaresOf(svg).empty());  // black borders only
  EXPECT_NE(svg.find("<path fill='none' stroke='black'"), std::string::npos);
  for (const std::string label : {">0.1<", ">1<", ">10<"}) EXPECT_NE(svg.find(label), std::string::npos) << label;
}

TEST_F(DrawApp, ColoursCellsByTheirErrorAndColumnsByTheLargestOne) {
  const std::string map = saveWithErrors(own("map.gmap"));
  const std::string svg = draw({map, "--color", "cell-error", "--box", "0", "0", "8", "4"});
  EXPECT_NE(svg.find(">map.gmap: scale 1 (4 m), 3 Gaussians<"), std::string::npos) << svg;
  EXPECT_NE(svg.find(">error of the cell [squared sigma]<"), std::string::npos);
  const double scale = scaleOf(svg, 8.0);
  const std::vector<Filled> squares = squaresOf(svg);
  ASSERT_EQ(squares.size(), 2u);  // seen from above, the two cells of the right column are one square
  EXPECT_NEAR(squares[0].x, 0.0, 0.01);
  EXPECT_NEAR(squares[1].x, 4.0 * scale, 0.01);
  EXPECT_NEAR(squares[1].width, 4.0 * scale, 0.01);
  EXPECT_EQ(squares[0].colour, "#440154");  // 62.5
  EXPECT_EQ(squares[1].colour, "#fde725");  // 6.25, not 0.0625
  for (const Drawn& ellipse : ellipsesOf(svg)) EXPECT_EQ(ellipse.colour, "#202020");
}

TEST_F(DrawApp, ShowsTheErrorsOfPlanarMapsToo) {
  std::vector<Vector<2>> points;
  for (int i = 0; i < 4000; ++i) points.emplace_back(0.01 * (i % 800), i < 2000 ? 0.3 * (i % 7) : 0.005 * (i % 800));
  const GaussianMap<2> map = build<2>(points, {0.2, 10, 2, 0.01});
  const std::vector<double> errors = cellErrors(map, 1).cells;
  const auto worst = static_cast<std::size_t>(std::max_element(errors.begin(), errors.end()) - errors.begin());
  const Vector<2> centre = map.grid().centre(map.scale(1).keys[worst], 1);
  gaussmap::save(own("planar.gmap"), map);

  const std::string svg = draw({own("planar.gmap"), "--color", "cell-error", "--box", "0", "0", "8", "4"});
  const double scale = scaleOf(svg, 8.0);
  const std::vector<Filled> squares = squaresOf(svg);
  EXPECT_EQ(squares.size(), errors.size());
  std::size_t dark = 0;
  for (const Filled& square : squares) {
    if (square.colour != "#440154") continue;
    ++dark;
    EXPECT_NEAR(square.x + 0.5 * square.width, centre.x() * scale, 0.01);
    EXPECT_NEAR(square.y + 0.5 * square.height, (4.0 - centre.y()) * scale, 0.01);
  }
  EXPECT_EQ(dark, 1u);
  EXPECT_EQ(ellipsesOf(draw({own("planar.gmap"), "--color", "contribution"})).size(), map.gaussianCount(0));
}

TEST_F(DrawApp, RefusesErrorsOfScalesThatHaveNone) {
  const std::string map = saveWithErrors(own("map.gmap")), svg = own("x.svg");
  const std::string one = save("one.gmap", {{0, 0, 0}}, {turnedGaussian({0, 0, 0}, 0.0)});
  expectUsageError("no scale is coarser than scale 1; use a finer --scale",
                   {"draw", map, "-o", svg, "--color", "contribution", "--scale", "1"});
  expectUsageError("no scale is finer", {"draw", map, "-o", svg, "--color", "cell-error", "--scale", "0"});
  expectUsageError("no scale is coarser", {"draw", one, "-o", svg, "--color", "contribution"});
  expectUsageError("no scale is finer", {"draw", one, "-o", svg, "--color", "cell-error"});
  expectUsageError("--color", {"draw", map, "-o", svg, "--color", "cell-error", "--overlay"});
  expectUsageError("--color", {"draw", map, "-o", svg, "--color", "weight"});
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
