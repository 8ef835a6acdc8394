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

#include "gaussmap/mesh/triangle_mesh.h"
#include "gaussmap/segments/segment_map.h"
#include "viewer/colouring.h"

namespace gaussmap {

/// The data that a viewer shows.
struct ViewScene {
  std::string name;
  std::variant<GaussianMap<3>, SegmentMap, TriangleMesh> map;  ///< a mesh: only a scene, without a map
  std::vector<Vector<3>> cloud;                                ///< [m], map frame; may be empty
  TriangleMesh mesh = {};                                      ///< [m], map frame, drawn with the map; may be empty
};

/// The position and direction of the eye.
struct ViewPoint {
  Vector<3> direction{-0.55, -0.8, 0.6};  ///< from the scene towards the eye, of any length
  bool perspective = true;                ///< false: parallel
  double zoom = 1.0;                      ///< 1 shows the whole scene; not used with `span`
  std::optional<double> span;             ///< height of the picture at the point to look at [m]
  std::optional<Vector<3>> middle;        ///< point to look at [m, map frame]; nullopt: middle of the scene
};

/// What the viewer shows, and how. The keys of the window change these options.
struct ViewOptions {
  ColourBy colour = ColourBy::Height;
  /// Scale to show; std::nullopt: leaves(), the map at its finest.
  std::optional<int> scale;
  double sigma = 2.0;  ///< half axes of the ellipsoids, in standard deviations
  bool cells = false;  ///< show the occupied cells as boxes
  bool cloud = true;   ///< show the cloud, if there is one
  bool mesh = true;    ///< show the mesh, if there is one
  /// Show all scales one above the other, linked to their children: Yguel 2009, Fig. 6. Of many links, an even
  /// selection is shown.
  bool hierarchy = false;
  bool help = false;  ///< show the keys on the screen
  /// Direction of heights and of the lift between scales. It points up in the picture (y does in a view from above).
  Vector<3> up = Vector<3>::UnitZ();
  ViewPoint view;
};

/// Returns a view from straight above, without perspective.
ViewPoint viewFromAbove(const Vector<3>& up);

/// Returns the finest scale with at most 200,000 Gaussians, which the viewer can rotate and zoom smoothly. Returns the
/// coarsest scale if there is none.
int scaleToShow(const GaussianMap<3>& map);

/// A picture, row by row from the top.
struct Picture {
  int width = 0, height = 0;
  std::vector<std::array<std::uint8_t, 3>> pixels;
};

/// Shows a scene with VTK. In a hierarchy it shows only scales of at most 200,000 Gaussians.
class Viewer {
 public:
  /// Throws std::invalid_argument if the scene is empty, if the map does not have the scale, if sigma, zoom or
  /// span is not positive, if `direction` or `up` is zero, or if a mesh has a fault.
  Viewer(ViewScene scene, const ViewOptions& options = {});
  ~Viewer();
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  const ViewOptions& options() const;
  /// Does what a key does in the window, see helpText(). Returns false for a key without a function.
  bool press(const std::string& key);
  static std::string helpText();

  /// Returns a picture without a window, by EGL or else on the display. Throws std::runtime_error if there is neither.
  Picture picture(int width, int height);
  /// Writes such a picture as a PNG file; the update is atomic (AtomicFile). Also throws FileError.
  void savePng(const std::filesystem::path& path, int width, int height);
  /// Opens a window and returns when it is closed. Throws std::runtime_error if there is no display.
  void show(int width, int height);

  struct Parts;  ///< uses VTK types, so it is in src/viewer/viewer_parts.h

 private:
  std::unique_ptr<Parts> parts_;
};

}  // namespace gaussmap
