// SPDX-License-Identifier: BSD-3-Clause
#include <vtkInteractorStyleTrackballCamera.h>
#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>

#include <chrono>
#include <stdexcept>

#include "viewer/off_screen_window.h"
#include "viewer/viewer_parts.h"

namespace gaussmap {
namespace {

constexpr double kSlow = 0.1;  // of a picture while the view moves [s]: the hand goes on before the eye

/// VTK's way to turn, shift and zoom, with our keys; few triangles while the view moves, points where that is slow.
class Style : public vtkInteractorStyleTrackballCamera {
 public:
  static Style* New() {
    auto* const made = new Style;
    made->InitializeObjectBase();
    return made;
  }
  Viewer::Parts* parts = nullptr;
  Detail moving = Detail::FewTriangles;  // while the view moves

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
    moving = Detail::FewTriangles;
    const int* const size = this->Interactor->GetRenderWindow()->GetSize();
    parts->build(size[0], size[1]);
    this->Interactor->Render();
  }
  void StartState(int state) override {
    parts->setDetail(moving);
    vtkInteractorStyleTrackballCamera::StartState(state);
  }
  void StopState() override {
    parts->setDetail(Detail::Round);
    vtkInteractorStyleTrackballCamera::StopState();
    this->Interactor->Render();
  }
  void OnMouseMove() override {
    const auto start = std::chrono::steady_clock::now();
    vtkInteractorStyleTrackballCamera::OnMouseMove();
    if (this->State == VTKIS_NONE || moving == Detail::Point) return;
    this->Interactor->GetRenderWindow()->WaitForCompletion();
    if (std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() < kSlow) return;
    moving = Detail::Point;
    parts->setDetail(moving);
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
