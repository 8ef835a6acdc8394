// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>

#include <map>
#include <vector>

#include "viewer/actors.h"
#include "viewer/viewer.h"

namespace gaussmap {

/// How much of each ellipsoid is drawn.
enum class Detail { Round, FewTriangles, Point };

/// What a viewer keeps: the scene, what is shown of it, and VTK's renderer with it.
struct Viewer::Parts {
  ViewScene scene;
  ViewOptions options;
  ViewPoint first_view;                  // what the key r goes back to
  Vector<3> origin = Vector<3>::Zero();  ///< of all actors [m, map frame]
  vtkNew<vtkRenderer> renderer;
  bool is_aimed = false;                                                ///< false: the camera is to be placed anew
  std::map<Detail, std::vector<vtkSmartPointer<vtkActor>>> ellipsoids;  ///< those of one detail are visible
  std::map<int, std::vector<double>> errors;                            ///< of a scale, once asked for

  const GaussianMap<3>* map() const { return std::get_if<GaussianMap<3>>(&scene.map); }
  /// Throws std::invalid_argument as Viewer().
  void check() const;
  /// Fills the renderer for a picture of this size.
  void build(int width, int height);
  /// Of the ellipsoids: Round after build().
  void setDetail(Detail detail);
  bool press(const std::string& key);
  Vector<3> up() const { return options.up.normalized(); }

 private:
  std::vector<Vector<3>> addMap(int height);
  std::vector<Vector<3>> addSegments();
  void addEllipsoids(const std::vector<GaussianId>& gaussians, const std::vector<Glyph>& glyphs, int height);
  void addCells(const std::vector<int>& scales, double lift);
  void addLinks(const std::vector<int>& scales, double lift);
  std::vector<double> errorsOf(const std::vector<GaussianId>& gaussians);
  std::vector<int> scalesOfHierarchy() const;
  std::string title() const;
};

}  // namespace gaussmap
