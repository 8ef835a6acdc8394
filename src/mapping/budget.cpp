// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/budget.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>
#include <variant>

namespace gaussmap::detail {
namespace {

template <typename Value>
void requireOption(bool good, const std::string& name, Value value, const std::string& rule) {
  if (good) return;
  std::ostringstream text;
  text << name << " = " << value << ": must be " << rule;
  throw std::invalid_argument(text.str());
}

/// Checks a budget of any kind.
struct BudgetCheck {
  int first_scale, scales, dimensions;

  void operator()(const PerCell& budget) const {
    requireOption(std::isfinite(budget.gaussians) && budget.gaussians >= 1.0, "budget", budget.gaussians,
                  "at least 1 Gaussian per cell");
  }
  void operator()(const MaxGaussians& budget) const {
    for (const auto& limit : budget.by_scale)
      requireOption(limit.first >= first_scale && limit.first < scales, "max_gaussians of scale", limit.first,
                    "one of the scales " + std::to_string(first_scale) + " to " + std::to_string(scales - 1));
  }
  void operator()(const MaxBytes& budget) const {
    if (dimensions == 2 ? !budget.planar_size_of : !budget.size_of)
      throw std::invalid_argument(std::string("max_bytes: ") + (dimensions == 2 ? "planar_size_of" : "size_of") +
                                  " is missing; use for example maxFileBytes()");
  }
  void operator()(const MaxError& budget) const {
    requireOption(std::isfinite(budget.metres) && budget.metres > 0.0, "max_error", budget.metres,
                  "a positive number of metres");
    checkSampling(budget.sampling);
  }
};

void checkCurves(const CurveOptions& curves) {
  checkSampling(curves.sampling);
  for (std::size_t i = 0; i < curves.multiples.size(); ++i)
    if (!(curves.multiples[i] >= 1.0) || (i > 0 && curves.multiples[i] <= curves.multiples[i - 1]))
      throw std::invalid_argument("multiples: must be at least 1 and increasing");
}

bool isMeasured(const Budget& budget) {
  return std::holds_alternative<MaxBytes>(budget) || std::holds_alternative<MaxError>(budget);
}

}  // namespace

void checkBudget(const Budget& budget, int first_scale, int scales, int dimensions) {
  std::visit(BudgetCheck{first_scale, scales, dimensions}, budget);
}

void checkSampling(const ErrorSampling& sampling) {
  if (sampling.samples == 0 || sampling.data == 0)
    throw std::invalid_argument("sampling: samples and data must be at least 1");
}

void checkRefinement(const Budget& budget, const RefineOptions& options, int scales, int dimensions) {
  checkBudget(budget, 1, scales, dimensions);
  requireOption(options.queue >= 0, "queue", options.queue, "at least 1 (0 = automatic)");
  requireOption(options.max_swaps >= 0, "max_swaps", options.max_swaps, "at least 0");
  requireOption(options.threads >= 0, "threads", options.threads, "at least 1 (0 = all cores)");
  if (options.curves) checkCurves(*options.curves);
  if (options.method != RefineMethod::Agglomerate && (options.curves || isMeasured(budget)))
    throw std::invalid_argument("method: error curves, MaxBytes and MaxError need RefineMethod::Agglomerate");
}

std::size_t extraGaussians(const Budget& budget, int scale, std::size_t cells, std::size_t available,
                           double otherwise) {
  double multiple = otherwise;
  if (const auto* limits = std::get_if<MaxGaussians>(&budget)) {
    const auto most = limits->by_scale.find(scale);
    if (most != limits->by_scale.end()) {
      if (most->second < cells)
        throw std::invalid_argument("max_gaussians = " + std::to_string(most->second) + ": scale " +
                                    std::to_string(scale) + " has " + std::to_string(cells) +
                                    " occupied cells, and each needs at least one; take coarser cells");
      return most->second - cells;
    }
  } else {
    multiple = std::get<PerCell>(budget).gaussians;
  }
  const double most = std::floor(multiple * static_cast<double>(cells));
  // A scale never uses more than the available Gaussians. The bound also keeps the conversion to an integer in range.
  const auto all = static_cast<std::size_t>(std::min(most, static_cast<double>(available)));
  return all - std::min(all, cells);
}

FittingMultiple largestMultiple(double most, std::uintmax_t max_bytes,
                                const std::function<std::uintmax_t(double)>& bytesAt) {
  const auto allowed = static_cast<double>(max_bytes);
  FittingMultiple fits{1.0, static_cast<double>(bytesAt(1.0))};
  double too_large = 0.0, too_many_bytes = 0.0;  // smallest multiple known not to fit, and its size; 0: none known
  for (double next = 2.0; fits.bytes <= allowed && fits.multiple < most &&
                          (too_large == 0.0 || too_large > fits.multiple * kBytePrecision);) {
    const double multiple = std::min(next, most);
    const auto bytes = static_cast<double>(bytesAt(multiple));
    if (bytes <= allowed)
      fits = {multiple, bytes};
    else
      too_large = multiple, too_many_bytes = bytes;
    // The size is nearly linear between two multiples, so interpolate. The bounds of 0.1 and 0.9 ensure progress.
    const double share = (allowed - fits.bytes) / (too_many_bytes - fits.bytes);
    next = too_large == 0.0 ? 2.0 * fits.multiple
                            : fits.multiple + std::clamp(share, 0.1, 0.9) * (too_large - fits.multiple);
  }
  return fits;
}

void requireRoom(std::uintmax_t max_bytes, std::uintmax_t one_per_cell) {
  if (one_per_cell > max_bytes)
    throw std::invalid_argument("max_bytes = " + std::to_string(max_bytes) + ": one Gaussian per cell takes " +
                                std::to_string(one_per_cell) +
                                " bytes already; take coarser cells, or compress the map");
}

}  // namespace gaussmap::detail
