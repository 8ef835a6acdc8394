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

constexpr double kSlow = 0.1;               // maximum time per picture while the view moves [s]
constexpr unsigned long kWheelRests = 300;  // pause after the last notch that ends a turn of the wheel [ms]

/// VTK's style to rotate, shift and zoom, with our keys. It draws few triangles while the view moves, or points if
/// triangles are too slow.
class Style : public vtkInteractorStyleTrackballCamera {
 public:
  static Style* New() {
    auto* const made = new Style;
    made->InitializeObjectBase();
    return made;
  }
  Viewer::Parts* parts = nullptr;

  void OnChar() override {}  // disables VTK's own keys
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
    moving_ = Detail::FewTriangles;
    slow_pictures_ = 0;
    if (this->State != VTKIS_NONE) parts->setDetail(moving_);
    this->Interactor->Render();
  }

  void StartState(int state) override {
    parts->setDetail(moving_);
    vtkInteractorStyleTrackballCamera::StartState(state);
  }
  void StopState() override {
    if (!is_in_wheel_) parts->setDetail(Detail::Round);  // before StopState(), which draws
    vtkInteractorStyleTrackballCamera::StopState();
  }
  void OnMouseMove() override {
    if (this->State == VTKIS_NONE) return vtkInteractorStyleTrackballCamera::OnMouseMove();
    move(1, [&] { vtkInteractorStyleTrackballCamera::OnMouseMove(); });
  }
  void OnMouseWheelForward() override {
    turnWheel([&] { vtkInteractorStyleTrackballCamera::OnMouseWheelForward(); });
  }
  void OnMouseWheelBackward() override {
    turnWheel([&] { vtkInteractorStyleTrackballCamera::OnMouseWheelBackward(); });
  }
  void OnTimer() override {
    if (this->State != VTKIS_NONE) return;
    parts->setDetail(Detail::Round);
    this->Interactor->Render();
  }

 protected:
  Style() = default;

 private:
  /// Draws this number of pictures of a moving view, and measures the time.
  template <typename Draw>
  void move(int pictures, const Draw& draw) {
    const auto start = std::chrono::steady_clock::now();
    draw();
    if (moving_ == Detail::Point) return;
    this->Interactor->GetRenderWindow()->WaitForCompletion();
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    slow_pictures_ = took.count() > pictures * kSlow ? slow_pictures_ + pictures : 0;
    if (slow_pictures_ < 2) return;  // a single picture may be slow for another reason
    moving_ = Detail::Point;
    if (this->State != VTKIS_NONE) parts->setDetail(moving_);
  }
  /// Handles a notch of the wheel, which is a motion by itself. If no other notch follows, the timer draws the full
  /// detail.
  template <typename Draw>
  void turnWheel(const Draw& draw) {
    this->Interactor->DestroyTimer(wheel_timer_);
    is_in_wheel_ = true;
    move(2, draw);
    is_in_wheel_ = false;
    wheel_timer_ = this->Interactor->CreateOneShotTimer(kWheelRests);
  }

  Detail moving_ = Detail::FewTriangles;  // while the view moves
  int slow_pictures_ = 0;                 // in a row
  bool is_in_wheel_ = false;
  int wheel_timer_ = 0;
};

}  // namespace

void Viewer::show(int width, int height) {
  if (!hasDisplay())
    throw std::runtime_error(
        "there is no display to open a window on: use --png FILE to write a picture without a display");
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
