// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace gaussmap::detail {

/// The learning rate eps(o) of Yguel 2009 eq. (5): linear between both rates. The defaults are those of the paper.
struct LearningRates {
  double slowest = 5e-4;       // eps_min, at the largest log-odds
  double fastest = 5e-2;       // eps_max, at the smallest log-odds
  double max_log_odds = 10.0;  // o_max

  double at(double log_odds) const {
    return (slowest - fastest) / (2.0 * max_log_odds) * (log_odds + max_log_odds) + fastest;
  }
};

}  // namespace gaussmap::detail
