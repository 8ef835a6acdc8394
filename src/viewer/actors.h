// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkActor.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <utility>
#include <vector>

#include "gaussmap/mesh/triangle_mesh.h"
#include "gaussmap/segments/segment_map.h"
#include "viewer/colouring.h"
#include "viewer/glyphs.h"

// Parts of the picture. All coordinates are relative to the origin of the scene.
namespace gaussmap {

/// Returns a unit sphere with this number of facets around its equator.
vtkSmartPointer<vtkPolyData> unitSphere(int facets);
/// Returns the numbers of facets for this many ellipsoids: for a still view, and for a moving view. With more facets
/// the drawing would not be smooth.
std::pair<int, int> facetsFor(std::size_t glyphs);

/// Returns an actor that draws all ellipsoids with one call to the graphics card: one sphere at many places.
vtkSmartPointer<vtkActor> ellipsoidActor(const std::vector<Glyph>& glyphs, const std::vector<detail::Colour>& colours,
                                         vtkPolyData* sphere);

/// Returns an actor that draws the centres as coloured points; if there are many, an even selection. A computer without
/// a graphics card can draw these fast enough.
vtkSmartPointer<vtkActor> centreActor(const std::vector<Glyph>& glyphs, const std::vector<detail::Colour>& colours);

struct Cube {
  Vector<3> centre;
  double side;
};
/// Returns an actor that draws the edges of cubes.
vtkSmartPointer<vtkActor> cubeActor(const std::vector<Cube>& cubes);

/// Returns an actor that draws lines between pairs of points.
vtkSmartPointer<vtkActor> linkActor(const std::vector<std::pair<Vector<3>, Vector<3>>>& links);

vtkSmartPointer<vtkActor> pointActor(const std::vector<Vector<3>>& points, const Vector<3>& origin);

/// Returns an actor that draws a mesh as a pale surface.
vtkSmartPointer<vtkActor> meshActor(const TriangleMesh& mesh, const Vector<3>& origin);

/// Returns actors that draw segments as vertical walls of this height [m]. Each chain has a colour; a pale band on the
/// ground shows the free side.
std::vector<vtkSmartPointer<vtkActor>> segmentActors(const SegmentMap& map, const Vector<3>& origin, double height);

}  // namespace gaussmap
