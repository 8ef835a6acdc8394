// SPDX-License-Identifier: BSD-3-Clause
// gaussmap_benchmark frame-times MAP: measures the time per picture of `gaussmap view`, while the view of a scale turns
// (few triangles, or points where triangles are slow) and when it stands still. Prints the name of the driver. Without
// a display it draws in software.
#include <vtkCamera.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "gaussmap/io/gmap/map_file.h"
#include "subcommands.h"
#include "viewer/glyphs.h"
#include "viewer/off_screen_window.h"
#include "viewer/viewer_parts.h"

namespace gaussmap::benchmark {
namespace {

constexpr int kWidth = 1200, kHeight = 800;

double medianMilliseconds(vtkRenderWindow& window, vtkRenderer& renderer, int pictures) {
  std::vector<double> times;
  for (int i = 0; i < pictures; ++i) {
    renderer.GetActiveCamera()->Azimuth(360.0 / pictures);
    renderer.ResetCameraClippingRange();
    const auto start = std::chrono::steady_clock::now();
    window.Render();
    window.WaitForCompletion();
    times.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
  }
  std::nth_element(times.begin(), times.begin() + pictures / 2, times.end());
  return times[static_cast<std::size_t>(pictures / 2)];
}

std::string driverOf(vtkRenderWindow& window) {
  std::istringstream lines(window.ReportCapabilities());
  for (std::string line; std::getline(lines, line);)
    if (line.rfind("OpenGL renderer string:", 0) == 0) return line.substr(25);
  return "unknown";
}

void measureFrames(const std::string& path) {
  Viewer::Parts parts;
  parts.scene.map = load(path);
  const GaussianMap<3> map = *parts.map();
  parts.origin = middleOf(map);
  for (int scale = scaleToShow(map); scale < map.scales(); ++scale) {
    parts.options.scale = scale;
    parts.is_aimed = false;
    parts.build(kWidth, kHeight);
    const vtkSmartPointer<vtkRenderWindow> window = makeOffScreenWindow();
    window->SetSize(kWidth, kHeight);
    window->AddRenderer(parts.renderer);
    window->Render();
    if (scale == scaleToShow(map)) std::printf("%s, %d x %d\n", driverOf(*window).c_str(), kWidth, kHeight);
    const auto millisecondsOf = [&](Detail detail, int pictures) {
      parts.setDetail(detail);
      return medianMilliseconds(*window, *parts.renderer, pictures);
    };
    const double moving = millisecondsOf(Detail::FewTriangles, 20), points = millisecondsOf(Detail::Point, 20),
                 still = millisecondsOf(Detail::Round, 5);
    std::printf(
        "scale %d, %zu Gaussians: %.1f ms a picture while it turns, %.1f ms as points, %.1f ms when it stands\n", scale,
        map.gaussianCount(scale), moving, points, still);
    window->RemoveRenderer(parts.renderer);
  }
}

}  // namespace

void addFrameTimes(CLI::App& app) {
  const auto map = std::make_shared<std::string>();
  CLI::App& command = *app.add_subcommand("frame-times", "how long a picture of a map takes");
  command.add_option("map", *map, "map file")->required();
  command.callback([map] { measureFrames(*map); });
}

}  // namespace gaussmap::benchmark
