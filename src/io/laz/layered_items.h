// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "io/laz/arithmetic_decoder.h"
#include "io/laz/chunk_decoder.h"

namespace gaussmap::detail {

/// One attribute of the points of a chunk. An empty layer means that the attribute never changes.
class LazLayer {
 public:
  /// Takes the data of the layer, which are empty if the layer is not wanted.
  void start(std::string_view data) {
    changes_ = !data.empty();
    if (changes_) coder_ = ArithmeticDecoder(data);
  }
  bool changes() const { return changes_; }
  bool failed() const { return changes_ && coder_.failed(); }
  ArithmeticDecoder& coder() { return coder_; }

 private:
  bool changes_ = false;
  ArithmeticDecoder coder_;
};

/// The scanner channels of a point record. Each channel has its own statistics and its own last point.
inline constexpr unsigned kScannerChannels = 4;

/// The scanner channel of a point, for the items after the first.
struct PointChannel {
  unsigned channel = 0;
  bool is_new = false;  ///< differs from the channel of the point before
};

/// Decodes one item of the points of formats 6 to 10.
class LayeredItem {
 public:
  virtual ~LayeredItem() = default;
  /// Returns the layers that store the item, one flag of LazLayers for each.
  virtual std::vector<unsigned> layers() const = 0;
  /// Forgets everything, and takes the item of the first point, which is not compressed, and its channel.
  virtual void start(const char* first, unsigned channel) = 0;
  /// Writes the item of the next point. `layers`: those of the item.
  virtual void decode(LazLayer* layers, PointChannel& channel, char* record) = 0;
  /// Returns true if the data are not valid.
  virtual bool failed() const { return false; }
};

/// Returns the decoder of the first item, which sets the channel.
std::unique_ptr<LayeredItem> layeredPoint();
/// Returns the decoder of another item.
std::unique_ptr<LayeredItem> layeredItem(const LazItem& item);

}  // namespace gaussmap::detail
