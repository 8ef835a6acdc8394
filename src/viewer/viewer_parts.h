// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>

#include <map>
#include <utility>
#include <vector>

#include "viewer/actors.h"
#include "viewer/viewer.h"

namespace gaussmap {

/// The level of detail of the ellipsoids.
enum class Detail { Round, FewTriangles, Point };

/// The state of a viewer: the scene, the options, and VTK's renderer.
struct Viewer::Parts {
  ViewScene scene;
  ViewOptions options;
  ViewPoint first_view;                  // view that the key r restores
  Vector<3> origin = Vector<3>::Zero();  ///< origin of all actors [m, map frame]
  vtkNew<vtkRenderer> renderer;
  bool is_aimed = false;                                                ///< false: build() must place the camera
  std::map<Detail, std::vector<vtkSmartPointer<vtkActor>>> ellipsoids;  ///< only those of one Detail are visible
  /// Of the Gaussians of a scale, for the colours that showsErrors(); computed on first use.
  std::map<std::pair<ColourBy, int>, std::vector<double>> errors;

  const GaussianMap<3>* map() const { return std::get_if<GaussianMap<3>>(&scene.map); }
  /// Throws std::invalid_argument like Viewer().
  void check() const;
  /// Fills the renderer for a picture of this size.
  void build(int width, int height);
  /// Sets the detail of the ellipsoids. After build() it is Detail::Round.
  void setDetail(Detail detail);
  bool press(const std::string& key);
  Vector<3> up() const { return options.up.normalized(); }

 private:
  std::vector<Vector<3>> addMap(int height);
  std::vector<Vector<3>> addSegments(const SegmentMap& segments);
  std::vector<Vector<3>> addMesh(const TriangleMesh& mesh);
  void addEllipsoids(const std::vector<GaussianId>& gaussians, const std::vector<Glyph>& glyphs, int height);
  void addCells(const std::vector<int>& scales, double lift);
  void addLinks(const std::vector<int>& scales, double lift);
  std::vector<double> errorsOf(const std::vector<GaussianId>& gaussians);
  /// Returns the scale of the cells to show: the coarser one for contributions, which belong to its cells.
  int scaleOfCells() const;
  std::vector<int> scalesOfHierarchy() const;
  std::string title() const;
};

}  // namespace gaussmap
