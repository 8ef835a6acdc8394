// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace gaussmap::detail {

/// Ranges of points that one plane is fitted to.
class PlaneRanges {
 public:
  static constexpr std::size_t kCapacity = 81;

  std::size_t size() const { return size_; }
  std::uint32_t first(std::size_t i) const { return first_[i + 1]; }
  std::uint32_t last(std::size_t i) const { return last_[i + 1]; }
  void clear() {
    end_ = 0xFFFFFFFFu;
    size_ = 0;
  }

  /// Adds ranges. It keeps the state that the next range depends on in registers, and writes it back in its destructor.
  /// Only one Adder may exist at a time.
  class Adder {
   public:
    explicit Adder(PlaneRanges& ranges)
        : ranges_(ranges), start_(ranges.start_), end_(ranges.end_), size_(ranges.size_) {}
    Adder(const Adder&) = delete;
    Adder& operator=(const Adder&) = delete;
    ~Adder() {
      ranges_.start_ = start_;
      ranges_.end_ = end_;
      ranges_.size_ = size_;
    }
    /// Adds a range, and joins it with the one before if it follows directly. A branch would be mispredicted too often,
    /// so there is none. Returns the size of the added range.
    std::uint32_t add(std::uint32_t from, std::uint32_t to) {
      const bool is_joined = from == end_;
      start_ = is_joined ? start_ : from;
      end_ = to;
      size_ += !is_joined;
      ranges_.first_[size_] = start_;
      ranges_.last_[size_] = end_;
      return to - from;
    }

   private:
    PlaneRanges& ranges_;
    std::uint32_t start_, end_;
    std::size_t size_;
  };

 private:
  std::array<std::uint32_t, kCapacity + 1> first_, last_;  // used from the second entry on
  std::uint32_t start_ = 0, end_ = 0xFFFFFFFFu;            // of the last range
  std::size_t size_ = 0;
};

/// Sums over points, whose coordinates are relative to one of the points: the products of x with (x, y, z, 1), then
/// those of y and z, and the number of points.
struct PlaneSums {
  std::array<double, 12> product{};
  double count = 0.0;
  static constexpr std::size_t kPadding = 8;
};

/// Returns the sums over the points of the ranges. `points`: x y z 1 per point, followed by kPadding points that do not
/// count. There must be at least one range, and no range may be empty.
PlaneSums sumUp(const std::array<float, 4>* points, const PlaneRanges& ranges);

/// Fits planes to many sets of points at once, in vector registers.
struct PlaneBatch {
  static constexpr std::size_t kCapacity = 64;
  alignas(64) double products[12][kCapacity] = {}, counts[kCapacity] = {};
  alignas(64) double normal[3][kCapacity], curvature[kCapacity];  ///< NaN if the points span no plane

  void set(std::size_t i, const PlaneSums& points) {
    for (std::size_t row = 0; row < 12; ++row) products[row][i] = points.product[row];
    counts[i] = points.count;
  }
  /// Fits the planes. Variances below `rounding` [m^2] count as zero.
  void solve(double rounding);
};

}  // namespace gaussmap::detail
