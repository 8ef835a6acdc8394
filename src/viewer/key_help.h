// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace gaussmap::detail {

/// What the keys of the window do, see Viewer::press(). This header needs no VTK, because commands print the text too.
inline constexpr const char* kKeyHelp =
    "0..9, Up, Down  scale (0 = finest)\n"
    "l               the map at its finest\n"
    "+ -             size of the ellipsoids\n"
    "c               colour: scale, height, normal, weight, occupancy, error, contribution, cell error\n"
    "g               cells\n"
    "p               cloud\n"
    "m               mesh\n"
    "h               hierarchy: scales lifted, children linked\n"
    "t i r           from above, from the side, as at the start\n"
    "F1 ?            this help\n"
    "q Esc           quit\n"
    "mouse           left turns, middle shifts, wheel zooms";

}  // namespace gaussmap::detail
