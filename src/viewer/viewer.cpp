// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/viewer.h"

#include <vtkImageData.h>
#include <vtkPNGWriter.h>
#include <vtkUnsignedCharArray.h>
#include <vtkWindowToImageFilter.h>

#include <stdexcept>

#include "gaussmap/map/grid.h"
#include "io/files/atomic_file.h"
#include "viewer/off_screen_window.h"
#include "viewer/viewer_parts.h"

namespace gaussmap {
using namespace detail;

namespace {

/// Returns a point near the middle of the map. Coordinates relative to it are precise enough as floats.
Vector<3> originOf(const ViewScene& scene) {
  if (const auto* map = std::get_if<GaussianMap<3>>(&scene.map)) return middleOf(*map);
  if (const auto* mesh = std::get_if<TriangleMesh>(&scene.map)) return mesh->vertices.front();
  const std::vector<Segment>& segments = std::get<SegmentMap>(scene.map).segments;
  if (segments.empty()) return Vector<3>::Zero();
  return {segments.front().start.x(), segments.front().start.y(), 0.0};
}

/// Draws the picture. The result is in VTK's order: rows from the bottom, three bytes per pixel.
vtkSmartPointer<vtkImageData> grab(vtkRenderer& renderer, int width, int height) {
  const vtkSmartPointer<vtkRenderWindow> window = makeOffScreenWindow();
  window->SetSize(width, height);
  window->SetMultiSamples(8);
  window->AddRenderer(&renderer);
  window->Render();
  vtkNew<vtkWindowToImageFilter> filter;
  filter->SetInput(window);
  filter->ReadFrontBufferOff();
  filter->ShouldRerenderOff();
  filter->Update();
  vtkSmartPointer<vtkImageData> image = filter->GetOutput();
  window->RemoveRenderer(&renderer);
  return image;
}

}  // namespace

ViewPoint viewFromAbove(const Vector<3>& up) {
  ViewPoint view;
  view.direction = up;
  view.perspective = false;
  return view;
}

Viewer::Viewer(ViewScene scene, const ViewOptions& options) : parts_(std::make_unique<Parts>()) {
  parts_->scene = std::move(scene);
  parts_->options = options;
  parts_->first_view = options.view;
  parts_->check();
  parts_->origin = originOf(parts_->scene);
}

Viewer::~Viewer() = default;

const ViewOptions& Viewer::options() const {
  return parts_->options;
}

bool Viewer::press(const std::string& key) {
  return parts_->press(key);
}

Picture Viewer::picture(int width, int height) {
  parts_->build(width, height);
  const vtkSmartPointer<vtkImageData> image = grab(*parts_->renderer, width, height);
  Picture picture;
  picture.width = image->GetDimensions()[0];
  picture.height = image->GetDimensions()[1];
  for (int row = picture.height; row-- > 0;)
    for (int column = 0; column < picture.width; ++column) {
      const auto* pixel = static_cast<const std::uint8_t*>(image->GetScalarPointer(column, row, 0));
      picture.pixels.push_back({pixel[0], pixel[1], pixel[2]});
    }
  return picture;
}

void Viewer::savePng(const std::filesystem::path& path, int width, int height) {
  parts_->build(width, height);
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputData(grab(*parts_->renderer, width, height));
  writer->WriteToMemoryOn();
  writer->SetCompressionLevel(9);
  writer->Write();
  const vtkUnsignedCharArray* const bytes = writer->GetResult();
  if (bytes == nullptr || bytes->GetNumberOfValues() == 0) throw std::runtime_error("the picture could not be encoded");
  AtomicFile file(path);
  file.write(const_cast<vtkUnsignedCharArray*>(bytes)->GetPointer(0),
             static_cast<std::size_t>(bytes->GetNumberOfValues()));
  file.commit();
}

}  // namespace gaussmap
