// SPDX-License-Identifier: BSD-3-Clause
// What the keys of the window do.
#include <algorithm>

#include "viewer/key_help.h"
#include "viewer/viewer_parts.h"

namespace gaussmap {

std::string Viewer::helpText() {
  return detail::kKeyHelp;
}

bool Viewer::Parts::press(const std::string& key) {
  const auto toggle = [](bool& flag) {
    flag = !flag;
    return true;
  };
  if (key == "F1" || key == "question") return toggle(options.help);
  if (key == "p") return toggle(options.cloud);
  if (key == "m") return toggle(options.mesh);
  if (key == "t" || key == "i" || key == "r") {
    options.view = key == "t" ? viewFromAbove(options.up) : key == "i" ? ViewPoint() : first_view;
    is_aimed = false;
    return true;
  }
  if (map() == nullptr) return false;
  const int coarsest = map()->scales() - 1;
  if (key.size() == 1 && key[0] >= '0' && key[0] <= '9') {
    if (key[0] - '0' > coarsest) return false;
    options.scale = key[0] - '0';
    return true;
  }
  if (key == "Up" || key == "Down") {
    options.scale = std::clamp(options.scale.value_or(-1) + (key == "Up" ? 1 : -1), 0, coarsest);
    return true;
  }
  if (key == "l") {
    options.scale.reset();
    return true;
  }
  if (key == "plus" || key == "equal" || key == "KP_Add" || key == "minus" || key == "KP_Subtract") {
    const bool larger = key[0] != 'm' && key != "KP_Subtract";
    options.sigma = std::clamp(options.sigma * (larger ? 1.25 : 0.8), 0.05, 50.0);
    return true;
  }
  if (key == "c") {
    options.colour = static_cast<ColourBy>((static_cast<int>(options.colour) + 1) % kColourings);
    return true;
  }
  if (key == "g") return toggle(options.cells);
  if (key == "h") {
    is_aimed = false;
    return toggle(options.hierarchy);
  }
  return false;
}

}  // namespace gaussmap
