// SPDX-License-Identifier: BSD-3-Clause
#include <vtkInteractorStyleTrackballCamera.h>
#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>

#include <stdexcept>

#include "viewer/off_screen_window.h"
#include "viewer/viewer_parts.h"

namespace gaussmap {
namespace {

/// VTK's way to turn, shift and zoom, with our keys; few triangles while the view moves.
class Style : public vtkInteractorStyleTrackballCamera {
 public:
  static Style* New() {
    auto* const made = new Style;
    made->InitializeObjectBase();
    return made;
  }
  Viewer::Parts* parts = nullptr;

  void OnChar() override {}  // VTK's own keys
  void OnKeyPress() override {
    const std::string key = this->Interactor->GetKeySym() != nullptr ? this->Interactor->GetKeySym() : "";
    if (key == "q" || key == "Escape") {
      this->Interactor->TerminateApp();
    } else if (parts->press(key)) {
      rebuild();
    }
  }
  void rebuild() {
    const int* const size = this->Interactor->GetRenderWindow()->GetSize();
    parts->build(size[0], size[1]);
    this->Interactor->Render();
  }
  void StartState(int state) override {
    parts->setMoving(true);
    vtkInteractorStyleTrackballCamera::StartState(state);
  }
  void StopState() override {
    parts->setMoving(false);
    vtkInteractorStyleTrackballCamera::StopState();
    this->Interactor->Render();
  }

 protected:
  Style() = default;
};

}  // namespace

void Viewer::show(int width, int height) {
  if (!hasDisplay())
    throw std::runtime_error("there is no display to open a window on: --png FILE makes a picture without one");
  vtkNew<vtkRenderWindow> window;
  window->SetSize(width, height);
  window->SetMultiSamples(4);
  window->SetWindowName(("gaussmap: " + parts_->scene.name).c_str());
  window->AddRenderer(parts_->renderer);
  vtkNew<vtkRenderWindowInteractor> interactor;
  interactor->SetRenderWindow(window);
  vtkNew<Style> style;
  style->parts = parts_.get();
  interactor->SetInteractorStyle(style);
  parts_->build(width, height);
  window->Render();
  interactor->Start();
  window->RemoveRenderer(parts_->renderer);
}

}  // namespace gaussmap
