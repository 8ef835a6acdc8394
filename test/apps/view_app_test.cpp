// SPDX-License-Identifier: BSD-3-Clause
// gaussmap view: pictures as files, and what it refuses. Without the viewer: that it says so.
#include <cstdlib>

#include "apps/app_fixture.h"

namespace gaussmap::test {
namespace {

/// An environment variable for the time of a test, in the programs that it starts.
class Environment {
 public:
  Environment(const char* name, const char* value) : name_(name) {
    if (const char* const old = std::getenv(name)) old_ = old;
    value != nullptr ? ::setenv(name, value, 1) : ::unsetenv(name);
  }
  ~Environment() { old_.empty() ? ::unsetenv(name_) : ::setenv(name_, old_.c_str(), 1); }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  const char* name_;
  std::string old_;
};

class ViewApp : public Apps {
 protected:
  void SetUp() override {
    if (GAUSSMAP_HAS_VIEWER == 0) GTEST_SKIP() << "built without the viewer";
  }
  static std::string map() { return scene("map.gmap").string(); }
  static std::size_t number(const std::string& png, std::size_t at) {
    std::size_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(png.at(at + i));
    return value;
  }
  Environment no_display_{"DISPLAY", nullptr};
};

TEST_F(ViewApp, SavesAPictureOfTheSizeAskedForWithoutADisplay) {
  const std::string said = succeed({"view", map(), "--png", own("a.png"), "--size", "320x200", "--scale", "1"});
  EXPECT_NE(said.find("320 x 200"), std::string::npos) << said;
  const std::string png = contentsOf(own("a.png"));
  ASSERT_GT(png.size(), 2000u);  // a blank one compresses to less
  EXPECT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1a\n");
  EXPECT_EQ(number(png, 16), 320u);
  EXPECT_EQ(number(png, 20), 200u);
  EXPECT_EQ(ownFiles(), (std::vector<std::string>{"a.png"}));
}

TEST_F(ViewApp, EveryOptionChangesThePicture) {
  std::vector<std::string> pictures;
  for (const std::vector<std::string>& more : {std::vector<std::string>{},
                                               {"--scale", "2"},
                                               {"--color", "normal"},
                                               {"--color", "error"},
                                               {"--color", "contribution"},
                                               {"--color", "cell-error"},
                                               {"--mesh", scene("truth.ply").string()},
                                               {"--span", "7"},
                                               {"--sigma", "1"},
                                               {"--cells"},
                                               {"--hierarchy"},
                                               {"--view", "top"},
                                               {"--view", "1,2,3"},
                                               {"--zoom", "2"},
                                               {"--up", "y"},
                                               {"--at", "1", "2", "3"},
                                               {scene("scans").string()}}) {
    std::vector<std::string> words = {"view", map(), "--png", own("a.png"), "--force", "--size", "160x120"};
    if (more.empty() || more[0] != "--scale") words.insert(words.end(), {"--scale", "1"});
    words.insert(words.end(), more.begin(), more.end());
    succeed(words);
    pictures.push_back(contentsOf(own("a.png")));
    for (std::size_t i = 0; i + 1 < pictures.size(); ++i)
      EXPECT_NE(pictures[i], pictures.back()) << testing::PrintToString(more);
  }
}

TEST_F(ViewApp, ShowsSegmentMaps) {
  succeed({"segments", scene("scans").string(), "--slice", "0.5", "1.5", "-o", own("walls.pcd")});
  EXPECT_NE(succeed({"view", own("walls.pcd"), "--png", own("walls.png"), "--size", "320x200"}), "");
  EXPECT_GT(contentsOf(own("walls.png")).size(), 2000u);
  expectUsageError("--scale", {"view", own("walls.pcd"), "--png", own("b.png"), "--scale", "1"});
}

TEST_F(ViewApp, ShowsMeshes) {
  const std::string said =
      succeed({"view", scene("truth.ply").string(), "--png", own("mesh.png"), "--size", "320x200"});
  EXPECT_NE(said.find("320 x 200"), std::string::npos) << said;
  EXPECT_GT(contentsOf(own("mesh.png")).size(), 2000u);
  for (const std::vector<std::string>& option :
       {std::vector<std::string>{"--scale", "1"}, {"--leaves"}, {"--color", "height"}, {"--cells"}, {"--hierarchy"}}) {
    std::vector<std::string> words = {"view", scene("truth.ply").string(), "--png", own("b.png")};
    words.insert(words.end(), option.begin(), option.end());
    expectUsageError(option[0] + ": not for meshes", words);
  }
}

TEST_F(ViewApp, SaysInOneLineThatThereIsNothingToDrawOn) {
  expectDataError("no display", {"view", map()});
  const Environment no_egl("__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent.json");
  expectDataError("xvfb-run", {"view", map(), "--png", own("a.png")});
}

TEST_F(ViewApp, RefusesWrongUsageAndWrongData) {
  const std::string png = own("a.png");
  expectUsageError(".png", {"view", map(), "--png", own("a.jpg")});
  expectUsageError("--size", {"view", map(), "--png", png, "--size", "100"});
  expectUsageError("--size", {"view", map(), "--png", png, "--size", "0x100"});
  expectUsageError("--view", {"view", map(), "--png", png, "--view", "behind"});
  expectUsageError("--view", {"view", map(), "--png", png, "--view", "0,0,0"});
  expectUsageError("--scale", {"view", map(), "--png", png, "--scale", "7"});
  expectUsageError("--leaves", {"view", map(), "--png", png, "--scale", "1", "--leaves"});
  expectUsageError("--color", {"view", map(), "--png", png, "--color", "pink"});
  expectUsageError("CLOUD", {"view", map(), "--png", png, "--color", "error", "--scale", "0"});
  expectUsageError("no scale is coarser", {"view", map(), "--png", png, "--color", "contribution", "--scale", "2"});
  expectUsageError("no scale is finer", {"view", map(), "--png", png, "--color", "cell-error", "--scale", "0"});
  expectUsageError("--leaves", {"view", map(), "--png", png, "--color", "cell-error", "--leaves"});
  expectUsageError("--span", {"view", map(), "--png", png, "--span", "0"});
  expectUsageError("--zoom", {"view", map(), "--png", png, "--span", "3", "--zoom", "2"});
  expectDataError("no.ply", {"view", map(), "--png", png, "--mesh", own("no.ply")});
  expectUsageError("--zoom", {"view", map(), "--png", png, "--zoom", "nan"});
  expectUsageError("map", {"view"});
  expectDataError("no.gmap", {"view", own("no.gmap"), "--png", png});
  expectDataError("not Gaussians", {"view", scene("truth.pcd").string(), "--png", png});
  directory_.write("mine.png", "mine");
  expectUsageError("--force", {"view", map(), "--png", own("mine.png")});
}

TEST_F(ViewApp, HasHelpWithItsKeys) {
  EXPECT_NE(succeed({"view", "--help"}).find("Example: gaussmap view"), std::string::npos);
  EXPECT_NE(succeed({"view", "--help-all"}).find("hierarchy: scales lifted"), std::string::npos);
}

TEST_F(Apps, WithoutTheViewerViewSaysHowToGetIt) {
  if (GAUSSMAP_HAS_VIEWER != 0) GTEST_SKIP() << "the viewer is built";
  expectDataError("GAUSSMAP_BUILD_VIEWER", {"view", scene("map.gmap").string()});
}

}  // namespace
}  // namespace gaussmap::test
