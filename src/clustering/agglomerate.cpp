// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/clustering/agglomerate.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>

#include "core/check.h"
#include "merge_neighbours.h"
#include "merge_table.h"

namespace gaussmap {
using namespace detail;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::uint32_t kUnknown = 0xFFFFFFFFu;

void checkOptions(const AgglomerateOptions& options) {
  require(options.neighbours >= 1, "neighbours", static_cast<double>(options.neighbours), "must be at least 1");
  require(options.restricted_until >= 1, "restricted_until", static_cast<double>(options.restricted_until),
          "must be at least 1");
}

/// Merges all clusters of a table; every pair is a candidate. Each slot stores its partner: the later slot that is
/// cheapest to merge with. If the partner is gone or has changed, its cost stays as a lower bound. The slot searches
/// for another partner only if this bound becomes the minimum of all slots (Muellner 2011, "generic" algorithm).
template <int D>
class ExactMerging {
 public:
  explicit ExactMerging(MergeHistory<D>& history) : history_(history), table_(history.table), row_(table_.slots()) {}

  void run() {
    live_ = table_.slots();
    least_.assign(live_, kInfinity);
    partner_.assign(live_, kUnknown);
    for (std::size_t i = 0; i + 1 < live_; ++i) findPartner(i);
    while (live_ > 1) {
      const std::size_t a = firstMinimum(least_.data(), least_.size());
      if (partner_[a] == kUnknown)
        findPartner(a);
      else
        merge(a, partner_[a]);
    }
  }

 private:
  void findPartner(std::size_t i) {
    const std::size_t first = i + 1, count = table_.slots() - first;
    table_.costs(i, first, table_.slots(), row_.data());
    setPartner(i, first, count);
  }
  void setPartner(std::size_t i, std::size_t first, std::size_t count) {
    const std::size_t best = count == 0 ? 0 : firstMinimum(row_.data(), count);
    least_[i] = count == 0 ? kInfinity : row_[best];
    partner_[i] = least_[i] < kInfinity ? static_cast<std::uint32_t>(first + best) : kUnknown;
  }

  void merge(std::size_t a, std::size_t b) {
    history_.merge(a, b, least_[a]);
    least_[b] = kInfinity;
    partner_[b] = kUnknown;
    if (--live_ == 1) return;
    table_.costs(a, 0, a, row_.data());
    for (std::size_t i = 0; i < a; ++i) {
      if (row_[i] < least_[i]) {
        least_[i] = row_[i];
        partner_[i] = static_cast<std::uint32_t>(a);
      } else if (partner_[i] == a || partner_[i] == b) {
        partner_[i] = kUnknown;
      } else if (row_[i] == least_[i] && partner_[i] != kUnknown && a < partner_[i]) {
        partner_[i] = static_cast<std::uint32_t>(a);
      }
    }
    for (std::size_t i = a + 1; i < b; ++i)
      if (partner_[i] == b) partner_[i] = kUnknown;
    findPartner(a);
    if (live_ * 8 < table_.slots() * 7) compact();
  }

  void compact() {
    const std::vector<std::uint32_t> kept = history_.compact();
    std::vector<std::uint32_t> moved(least_.size(), kUnknown);
    for (std::size_t slot = 0; slot < kept.size(); ++slot) moved[kept[slot]] = static_cast<std::uint32_t>(slot);
    for (std::size_t slot = 0; slot < kept.size(); ++slot) {
      least_[slot] = least_[kept[slot]];
      const std::uint32_t partner = partner_[kept[slot]];
      partner_[slot] = partner == kUnknown ? kUnknown : moved[partner];
    }
    least_.resize(kept.size());
    partner_.resize(kept.size());
  }

  MergeHistory<D>& history_;
  MergeTable<D>& table_;
  std::size_t live_ = 0;
  std::vector<double> least_;           // cost of merging with the partner; a lower bound if the partner is unknown
  std::vector<std::uint32_t> partner_;  // a later slot
  std::vector<double> row_;
};

}  // namespace

template <int D>
Dendrogram agglomerate(const std::vector<Gaussian<D>>& data, const std::vector<double>& areas,
                       const AgglomerateOptions& options) {
  checkOptions(options);
  MergeHistory<D> history(data, areas, options.cost);
  if (data.size() > options.max_exact) mergeNeighbours(history, options.neighbours, options.restricted_until);
  ExactMerging<D>(history).run();
  return std::move(history.dendrogram);
}

std::vector<int> labels(const Dendrogram& dendrogram, std::size_t k) {
  const std::size_t n = dendrogram.size;
  if (n == 0) return {};
  if (k < 1 || k > n)
    throw std::invalid_argument("labels: " + std::to_string(k) + " clusters of " + std::to_string(n) +
                                " Gaussians: give 1 to n clusters");
  const std::size_t made = n - k;
  std::vector<std::uint32_t> top(n + made);  // per node: the node of the last merge that contains it
  std::iota(top.begin(), top.end(), 0u);
  for (std::size_t t = made; t-- > 0;) top[dendrogram.merges[t].first] = top[dendrogram.merges[t].second] = top[n + t];
  std::vector<int> label_of(n + made, -1), result(n);
  int next = 0;
  for (std::size_t j = 0; j < n; ++j) {
    int& label = label_of[top[j]];
    if (label < 0) label = next++;
    result[j] = label;
  }
  return result;
}

template Dendrogram agglomerate<2>(const std::vector<Gaussian<2>>&, const std::vector<double>&,
                                   const AgglomerateOptions&);
template Dendrogram agglomerate<3>(const std::vector<Gaussian<3>>&, const std::vector<double>&,
                                   const AgglomerateOptions&);

}  // namespace gaussmap
