// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkActor.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <utility>
#include <vector>

#include "gaussmap/segments/segment_map.h"
#include "viewer/colouring.h"
#include "viewer/glyphs.h"

// Pieces of the picture, all about the origin of the scene.
namespace gaussmap {

/// A unit sphere of `facets` round its equator.
vtkSmartPointer<vtkPolyData> unitSphere(int facets);
/// As round as so many of them can be drawn smoothly; the second while the view moves.
std::pair<int, int> facetsFor(std::size_t glyphs);

/// All ellipsoids by one call to the graphics card: the sphere once, and its places.
vtkSmartPointer<vtkActor> ellipsoidActor(const std::vector<Glyph>& glyphs, const std::vector<detail::Colour>& colours,
                                         vtkPolyData* sphere);

/// Their centres as coloured points, of many an even choice: what a machine without a graphics card can turn.
vtkSmartPointer<vtkActor> centreActor(const std::vector<Glyph>& glyphs, const std::vector<detail::Colour>& colours);

struct Cube {
  Vector<3> centre;
  double side;
};
/// The edges of boxes.
vtkSmartPointer<vtkActor> cubeActor(const std::vector<Cube>& cubes);

/// Lines between two points each.
vtkSmartPointer<vtkActor> linkActor(const std::vector<std::pair<Vector<3>, Vector<3>>>& links);

vtkSmartPointer<vtkActor> pointActor(const std::vector<Vector<3>>& points, const Vector<3>& origin);

/// Segments as upright walls of this height [m], each chain in a colour, a pale band on the ground where it is free.
std::vector<vtkSmartPointer<vtkActor>> segmentActors(const SegmentMap& map, const Vector<3>& origin, double height);

}  // namespace gaussmap
