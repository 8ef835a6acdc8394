// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "gaussmap/segments/segment_map.h"
#include "viewer/colouring.h"

namespace gaussmap {

/// What there is to look at.
struct ViewScene {
  std::string name;
  std::variant<GaussianMap<3>, SegmentMap> map;
  std::vector<Vector<3>> cloud;  ///< [m], map frame; may be empty
};

/// Where the eye is.
struct ViewPoint {
  Vector<3> direction{-0.55, -0.8, 0.6};  ///< from the scene towards the eye, any length
  bool perspective = true;                ///< false: parallel
  double zoom = 1.0;                      ///< 1: the whole scene
  std::optional<Vector<3>> middle;        ///< looked at [m, map frame]; nothing: the middle of the scene
};

/// What is shown, and how. The keys of the window change it.
struct ViewOptions {
  ColourBy colour = ColourBy::Height;
  /// Nothing: leaves(), the map at its finest.
  std::optional<int> scale;
  double sigma = 2.0;      ///< half axes of the ellipsoids, in standard deviations
  bool cells = false;      ///< the occupied cells as boxes
  bool cloud = true;       ///< the cloud, if there is one
  bool hierarchy = false;  ///< all scales lifted one above the other, linked to their children: Yguel 2009, Fig. 6
  bool help = false;       ///< the keys, on screen
  /// Along which heights count, scales are lifted, and what is up in the picture (from straight above: y).
  Vector<3> up = Vector<3>::UnitZ();
  ViewPoint view;
};

/// From straight above, without perspective.
ViewPoint viewFromAbove(const Vector<3>& up);

/// The finest scale of at most 200,000 Gaussians, which stay smooth to turn and zoom; the coarsest if there is none.
int scaleToShow(const GaussianMap<3>& map);

/// A picture, row after row from the top.
struct Picture {
  int width = 0, height = 0;
  std::vector<std::array<std::uint8_t, 3>> pixels;
};

/// Shows a scene by VTK. Of a hierarchy only scales of at most 200,000 Gaussians are shown.
class Viewer {
 public:
  /// Throws std::invalid_argument: nothing in the scene, no such scale, a sigma or zoom that is not positive, no
  /// direction, no up.
  Viewer(ViewScene scene, const ViewOptions& options = {});
  ~Viewer();
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  const ViewOptions& options() const;
  /// What a key does in the window: see helpText(). False for a key without meaning.
  bool press(const std::string& key);
  static std::string helpText();

  /// A picture without a window, by EGL or else on the display. Throws std::runtime_error if there is neither.
  Picture picture(int width, int height);
  /// The same as a PNG file, whole or not at all (AtomicFile). Throws FileError too.
  void savePng(const std::filesystem::path& path, int width, int height);
  /// Opens a window and returns when it is closed. Throws std::runtime_error if there is no display.
  void show(int width, int height);

  struct Parts;  ///< with VTK's types: src/viewer/viewer_parts.h

 private:
  std::unique_ptr<Parts> parts_;
};

}  // namespace gaussmap
