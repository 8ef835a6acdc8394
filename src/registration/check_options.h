// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gaussmap/registration/registration.h"

namespace gaussmap::detail {

/// Throws std::invalid_argument if the map is empty, the guess has a fault, or an option is out of range. The message
/// names the option.
void checkRegistration(bool is_map_empty, const Pose& guess, const RegistrationOptions& options);

}  // namespace gaussmap::detail
