// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/legend.h"

#include <vtkCoordinate.h>
#include <vtkDoubleArray.h>
#include <vtkLookupTable.h>
#include <vtkNew.h>
#include <vtkScalarBarActor.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>

#include <algorithm>
#include <cmath>

namespace gaussmap {
using namespace detail;

namespace {

constexpr double kInk = 0.15;
constexpr double kGround = 0.6;  // opacity of the white ground that makes text readable in front of any colour

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
  actor->GetTextProperty()->SetBackgroundOpacity(kGround);
  const bool right = corner == Corner::TopRight, top = corner != Corner::BottomLeft;
  actor->GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
  actor->SetPosition(right ? 0.985 : 0.015, top ? 0.98 : 0.02);
  if (right) actor->GetTextProperty()->SetJustificationToRight();
  if (top) actor->GetTextProperty()->SetVerticalJustificationToTop();
  return actor;
}

namespace {

/// Returns round numbers in a range of positive values: powers of ten or, if there are less than two, also 2 and 5
/// times these powers.
vtkSmartPointer<vtkDoubleArray> roundFactors(double low, double high) {
  const auto powerOf = [](double value) { return static_cast<int>(std::floor(std::log10(value))); };
  const auto labels = vtkSmartPointer<vtkDoubleArray>::New();
  for (const bool with_steps : {false, true}) {
    labels->Reset();
    for (int power = powerOf(low); power <= powerOf(high); ++power)
      for (const double step : {1.0, 2.0, 5.0}) {
        const double label = step * std::pow(10.0, power);
        if ((with_steps || step == 1.0) && label >= low && label <= high) labels->InsertNextValue(label);
      }
    if (labels->GetNumberOfValues() >= 2) break;
  }
  return labels;
}

/// Returns round numbers in a range, at equal steps: three to eight of them.
vtkSmartPointer<vtkDoubleArray> roundSteps(double low, double high) {
  const double decade = std::pow(10.0, std::floor(std::log10((high - low) / 3.0)));
  double step = decade;
  for (const double factor : {2.0, 5.0})
    if (factor * decade <= (high - low) / 3.0) step = factor * decade;
  const auto labels = vtkSmartPointer<vtkDoubleArray>::New();
  for (double k = std::ceil(low / step); k * step <= high; ++k) labels->InsertNextValue(k * step + 0.0);  // no -0
  return labels;
}

vtkSmartPointer<vtkActor2D> barOf(const Colouring& colouring, int height) {
  vtkNew<vtkLookupTable> table;
  const auto count = static_cast<vtkIdType>(colouring.bar.size());
  table->SetNumberOfTableValues(count);
  for (vtkIdType i = 0; i < count; ++i) {
    const Colour& colour = colouring.bar[static_cast<std::size_t>(i)];
    table->SetTableValue(i, colour[0] / 255.0, colour[1] / 255.0, colour[2] / 255.0);
  }
  if (colouring.is_logarithmic) table->SetScaleToLog10();
  table->SetTableRange(colouring.low, colouring.high);
  const auto bar = vtkSmartPointer<vtkScalarBarActor>::New();
  bar->SetCustomLabels(colouring.is_logarithmic ? roundFactors(colouring.low, colouring.high)
                                                : roundSteps(colouring.low, colouring.high));
  bar->UseCustomLabelsOn();
  bar->SetLabelFormat("%-.6g");
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
  for (vtkTextProperty* const text : {bar->GetTitleTextProperty(), bar->GetLabelTextProperty()}) {
    text->SetBackgroundColor(1.0, 1.0, 1.0);
    text->SetBackgroundOpacity(kGround);
  }
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
