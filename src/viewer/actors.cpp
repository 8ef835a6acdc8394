// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/actors.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkFloatArray.h>
#include <vtkGlyph3DMapper.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>

#include "mesh/shapes.h"

namespace gaussmap {
using namespace detail;

namespace {

vtkSmartPointer<vtkUnsignedCharArray> colourArray(const std::vector<Colour>& colours) {
  const auto array = vtkSmartPointer<vtkUnsignedCharArray>::New();
  array->SetName("colour");
  array->SetNumberOfComponents(3);
  for (const Colour& colour : colours) array->InsertNextTypedTuple(colour.data());
  return array;
}

template <std::size_t N>
void addArray(vtkPolyData& places, const char* name, const std::vector<Glyph>& glyphs,
              std::array<float, N> Glyph::*member) {
  vtkNew<vtkFloatArray> array;
  array->SetName(name);
  array->SetNumberOfComponents(static_cast<int>(N));
  array->SetNumberOfTuples(static_cast<vtkIdType>(glyphs.size()));
  for (std::size_t i = 0; i < glyphs.size(); ++i)
    array->SetTypedTuple(static_cast<vtkIdType>(i), (glyphs[i].*member).data());
  places.GetPointData()->AddArray(array);
}

vtkIdType insert(vtkPoints& points, const Vector<3>& point) {
  return points.InsertNextPoint(point.data());
}

vtkSmartPointer<vtkActor> actorOf(vtkPolyData* data) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data);
  const auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  return actor;
}

/// Switches the light off: lines and points have the same colour from every side.
void makeFlat(vtkActor& actor, const Colour& colour, double opacity) {
  actor.GetProperty()->LightingOff();
  actor.GetProperty()->SetColor(colour[0] / 255.0, colour[1] / 255.0, colour[2] / 255.0);
  actor.GetProperty()->SetOpacity(opacity);
}

}  // namespace

vtkSmartPointer<vtkPolyData> unitSphere(int facets) {
  const TriangleMesh mesh = ellipsoidMesh(Vector<3>::Zero(), Vector<3>::Ones(), facets);
  vtkNew<vtkPoints> points;
  vtkNew<vtkFloatArray> normals;
  normals->SetNumberOfComponents(3);
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    insert(*points, vertex);
    normals->InsertNextTuple(vertex.data());  // on a unit sphere, normal and vertex are equal
  }
  vtkNew<vtkCellArray> triangles;
  for (const TriangleMesh::Triangle& triangle : mesh.triangles)
    triangles->InsertNextCell({vtkIdType{triangle[0]}, vtkIdType{triangle[1]}, vtkIdType{triangle[2]}});
  const auto sphere = vtkSmartPointer<vtkPolyData>::New();
  sphere->SetPoints(points);
  sphere->SetPolys(triangles);
  sphere->GetPointData()->SetNormals(normals);
  return sphere;
}

std::pair<int, int> facetsFor(std::size_t glyphs) {
  if (glyphs <= 3000) return {32, 16};
  if (glyphs <= 40000) return {12, 6};
  if (glyphs <= 200000) return {8, 4};
  return {6, 4};
}

vtkSmartPointer<vtkActor> ellipsoidActor(const std::vector<Glyph>& glyphs, const std::vector<Colour>& colours,
                                         vtkPolyData* sphere) {
  vtkNew<vtkPoints> centres;
  for (const Glyph& glyph : glyphs) centres->InsertNextPoint(glyph.centre.data());
  vtkNew<vtkPolyData> places;
  places->SetPoints(centres);
  addArray(*places, "rotation", glyphs, &Glyph::rotation);
  addArray(*places, "half_axes", glyphs, &Glyph::half_axes);
  places->GetPointData()->AddArray(colourArray(colours));
  vtkNew<vtkGlyph3DMapper> mapper;
  mapper->SetInputData(places);
  mapper->SetSourceData(sphere);
  mapper->SetOrientationModeToQuaternion();
  mapper->SetOrientationArray("rotation");
  mapper->SetScaleModeToScaleByVectorComponents();
  mapper->SetScaleArray("half_axes");
  mapper->SetScalarModeToUsePointFieldData();
  mapper->SelectColorArray("colour");
  const auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  actor->GetProperty()->SetAmbient(0.3);
  actor->GetProperty()->SetDiffuse(0.8);
  actor->GetProperty()->SetSpecular(0.08);
  actor->GetProperty()->SetSpecularPower(12.0);
  return actor;
}

vtkSmartPointer<vtkActor> centreActor(const std::vector<Glyph>& glyphs, const std::vector<Colour>& colours) {
  constexpr std::size_t kMax = 60000;
  const std::size_t step = (glyphs.size() + kMax - 1) / kMax;
  vtkNew<vtkPoints> centres;
  vtkNew<vtkCellArray> cells;
  std::vector<Colour> chosen;
  for (std::size_t i = 0; i < glyphs.size(); i += step) {
    cells->InsertNextCell({centres->InsertNextPoint(glyphs[i].centre.data())});
    chosen.push_back(colours[i]);
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(centres);
  data->SetVerts(cells);
  data->GetPointData()->SetScalars(colourArray(chosen));
  const auto actor = actorOf(data);
  actor->GetProperty()->LightingOff();
  actor->GetProperty()->SetPointSize(3.0f);
  return actor;
}

vtkSmartPointer<vtkActor> cubeActor(const std::vector<Cube>& cubes) {
  vtkNew<vtkPoints> corners;
  vtkNew<vtkCellArray> edges;
  for (const Cube& cube : cubes) {
    const vtkIdType first = corners->GetNumberOfPoints();
    for (int corner = 0; corner < 8; ++corner)
      insert(*corners, cube.centre + 0.5 * cube.side *
                                         Vector<3>((corner & 1) != 0 ? 1.0 : -1.0, (corner & 2) != 0 ? 1.0 : -1.0,
                                                   (corner & 4) != 0 ? 1.0 : -1.0));
    for (int corner = 0; corner < 8; ++corner)
      for (const int axis : {1, 2, 4})
        if ((corner & axis) == 0) edges->InsertNextCell({first + corner, first + (corner | axis)});
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(corners);
  data->SetLines(edges);
  const auto actor = actorOf(data);
  makeFlat(*actor, {60, 60, 70}, 0.35);
  return actor;
}

vtkSmartPointer<vtkActor> linkActor(const std::vector<std::pair<Vector<3>, Vector<3>>>& links) {
  vtkNew<vtkPoints> ends;
  vtkNew<vtkCellArray> lines;
  for (const auto& [from, to] : links) {
    const vtkIdType start = insert(*ends, from);
    lines->InsertNextCell({start, insert(*ends, to)});
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(ends);
  data->SetLines(lines);
  const auto actor = actorOf(data);
  makeFlat(*actor, {70, 70, 80}, std::clamp(300.0 / static_cast<double>(links.size()), 0.012, 0.4));
  return actor;
}

vtkSmartPointer<vtkActor> pointActor(const std::vector<Vector<3>>& points, const Vector<3>& origin) {
  vtkNew<vtkPoints> places;
  vtkNew<vtkCellArray> cells;
  for (const Vector<3>& point : points)
    if (point.allFinite()) cells->InsertNextCell({insert(*places, point - origin)});
  vtkNew<vtkPolyData> data;
  data->SetPoints(places);
  data->SetVerts(cells);
  const auto actor = actorOf(data);
  makeFlat(*actor, {25, 25, 30}, 1.0);
  actor->GetProperty()->SetPointSize(2.0f);
  return actor;
}

vtkSmartPointer<vtkActor> meshActor(const TriangleMesh& mesh, const Vector<3>& origin) {
  vtkNew<vtkPoints> corners;
  vtkNew<vtkCellArray> faces;
  for (const Vector<3>& vertex : mesh.vertices) insert(*corners, vertex - origin);
  for (const TriangleMesh::Triangle& triangle : mesh.triangles)
    faces->InsertNextCell({vtkIdType{triangle[0]}, vtkIdType{triangle[1]}, vtkIdType{triangle[2]}});
  vtkNew<vtkPolyData> data;
  data->SetPoints(corners);
  data->SetPolys(faces);
  const auto actor = actorOf(data);
  actor->GetProperty()->SetInterpolationToFlat();
  actor->GetProperty()->SetColor(0.84, 0.82, 0.77);
  actor->GetProperty()->SetAmbient(0.25);
  actor->GetProperty()->SetDiffuse(0.8);
  return actor;
}

std::vector<vtkSmartPointer<vtkActor>> segmentActors(const SegmentMap& map, const Vector<3>& origin, double height) {
  constexpr Colour kColours[] = {{0, 114, 178}, {213, 94, 0},   {0, 158, 115}, {204, 121, 167},
                                 {230, 159, 0}, {86, 180, 233}, {90, 90, 90}};
  vtkNew<vtkPoints> corners;
  vtkNew<vtkCellArray> walls, bands;
  std::vector<Colour> colours;
  const auto at = [&](const Vector<2>& point, double z) {
    return insert(*corners, Vector<3>(point.x() - origin.x(), point.y() - origin.y(), z));
  };
  for (std::size_t c = 0; c < map.chains.size(); ++c) {
    for (std::size_t i = map.chains[c].first; i < map.chains[c].last; ++i) {
      const Segment& segment = map.segments[i];
      const Vector<2> band = 0.4 * height * segment.normal();
      const vtkIdType start = at(segment.start, 0.0), end = at(segment.end, 0.0);
      walls->InsertNextCell({start, end, at(segment.end, height), at(segment.start, height)});
      bands->InsertNextCell({start, end, at(segment.end + band, 0.0), at(segment.start + band, 0.0)});
      colours.push_back(kColours[c % std::size(kColours)]);
    }
  }
  std::vector<vtkSmartPointer<vtkActor>> actors;
  for (vtkCellArray* const faces : {walls.Get(), bands.Get()}) {
    vtkNew<vtkPolyData> data;
    data->SetPoints(corners);
    data->SetPolys(faces);
    data->GetCellData()->SetScalars(colourArray(colours));
    actors.push_back(actorOf(data));
    actors.back()->GetProperty()->SetOpacity(actors.size() == 1 ? 1.0 : 0.25);
  }
  actors.back()->GetProperty()->LightingOff();
  return actors;
}

}  // namespace gaussmap
