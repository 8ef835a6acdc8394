// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/legend.h"

#include <vtkCoordinate.h>
#include <vtkLookupTable.h>
#include <vtkNew.h>
#include <vtkScalarBarActor.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>

#include <algorithm>
#include <cmath>

namespace gaussmap {
namespace {

constexpr double kInk = 0.15;

int fontSize(int height) {
  return std::clamp(height / 45, 11, 28);
}

void setText(vtkTextProperty& property, int size) {
  property.SetFontFamilyToArial();
  property.SetFontSize(size);
  property.SetColor(kInk, kInk, kInk);
  property.BoldOff();
  property.ItalicOff();
  property.ShadowOff();
}

}  // namespace

vtkSmartPointer<vtkActor2D> textActor(const std::string& text, Corner corner, int height) {
  const auto actor = vtkSmartPointer<vtkTextActor>::New();
  actor->SetInput(text.c_str());
  setText(*actor->GetTextProperty(), fontSize(height));
  actor->GetTextProperty()->SetBackgroundColor(1.0, 1.0, 1.0);
  actor->GetTextProperty()->SetBackgroundOpacity(0.6);  // readable in front of any colour
  const bool right = corner == Corner::TopRight, top = corner != Corner::BottomLeft;
  actor->GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
  actor->SetPosition(right ? 0.985 : 0.015, top ? 0.98 : 0.02);
  if (right) actor->GetTextProperty()->SetJustificationToRight();
  if (top) actor->GetTextProperty()->SetVerticalJustificationToTop();
  return actor;
}

namespace {

vtkSmartPointer<vtkActor2D> barOf(const Colouring& colouring, int height) {
  vtkNew<vtkLookupTable> table;
  const auto count = static_cast<vtkIdType>(colouring.bar.size());
  table->SetNumberOfTableValues(count);
  for (vtkIdType i = 0; i < count; ++i) {
    const Colour& colour = colouring.bar[static_cast<std::size_t>(i)];
    table->SetTableValue(i, colour[0] / 255.0, colour[1] / 255.0, colour[2] / 255.0);
  }
  const auto label = [&](double end) { return std::abs(end) < 1e-6 * (colouring.high - colouring.low) ? 0.0 : end; };
  table->SetTableRange(label(colouring.low), label(colouring.high));  // writes 0 instead of -1.39e-17
  const auto bar = vtkSmartPointer<vtkScalarBarActor>::New();
  bar->SetNumberOfLabels(5);
  bar->SetLabelFormat("%-.3g");
  bar->SetLookupTable(table);
  bar->SetMaximumNumberOfColors(static_cast<int>(count));
  bar->SetTitle(colouring.title.c_str());
  bar->SetVerticalTitleSeparation(height / 60);
  bar->UnconstrainedFontSizeOn();
  setText(*bar->GetTitleTextProperty(), fontSize(height));
  setText(*bar->GetLabelTextProperty(), fontSize(height));
  bar->GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
  bar->SetPosition(0.88, 0.04);
  bar->SetWidth(0.11);
  bar->SetHeight(0.4);
  bar->SetBarRatio(0.2);
  return bar;
}

}  // namespace

std::vector<vtkSmartPointer<vtkActor2D>> colourBar(const Colouring& colouring, int height) {
  if (colouring.names.empty()) return {barOf(colouring, height)};
  std::vector<vtkSmartPointer<vtkActor2D>> actors;
  for (std::size_t i = 0; i < colouring.names.size(); ++i) {
    const auto actor = vtkSmartPointer<vtkTextActor>::New();
    const Colour& colour = colouring.bar[i];
    actor->SetInput((" " + colouring.title + " " + colouring.names[i] + " ").c_str());
    setText(*actor->GetTextProperty(), fontSize(height));
    actor->GetTextProperty()->SetBackgroundColor(colour[0] / 255.0, colour[1] / 255.0, colour[2] / 255.0);
    actor->GetTextProperty()->SetBackgroundOpacity(1.0);
    actor->GetTextProperty()->SetJustificationToRight();
    actor->GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
    actor->SetPosition(0.98, 0.04 + 0.045 * static_cast<double>(i));
    actors.push_back(actor);
  }
  return actors;
}

}  // namespace gaussmap
