// SPDX-License-Identifier: BSD-3-Clause
#include "registration/check_options.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "core/check.h"

namespace gaussmap::detail {

void checkRegistration(bool is_map_empty, const Pose& guess, const RegistrationOptions& options) {
  if (is_map_empty) throw std::invalid_argument("the map is empty: there is nothing to register with");
  if (const std::string fault = poseFault(guess); !fault.empty()) throw std::invalid_argument("guess: " + fault);
  require(options.resolution >= 0.0 && std::isfinite(options.resolution), "resolution", options.resolution,
          "must be positive and finite (0 = the finest cells)");
  require(options.max_gaussians >= 1, "max_gaussians", double(options.max_gaussians), "must be at least 1");
  require(options.max_iterations >= 1, "max_iterations", options.max_iterations, "must be at least 1");
  require(options.kernel > 0.0, "kernel", options.kernel, "must be positive");
  require(options.translation > 0.0, "translation", options.translation, "must be positive");
  require(options.rotation > 0.0, "rotation", options.rotation, "must be positive");
  require(options.degenerate >= 0.0, "degenerate", options.degenerate, "must not be negative");
  require(options.threads >= 0, "threads", options.threads, "must be at least 1 (0 = all)");
}

}  // namespace gaussmap::detail
