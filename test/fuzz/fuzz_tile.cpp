// SPDX-License-Identifier: BSD-3-Clause
// Tiles of 3-D and 2-D maps. No input of a fuzzer has a correct zstd checksum. So the bytes are decoded as they are,
// and again as the content of a valid zstd frame. A tile that can be decoded must be encodable again.
#include <zstd.h>

#include <cstdint>
#include <cstdlib>
#include <stdexcept>

#include "io/gmap/tile_codec.h"

namespace {

using namespace gaussmap;
using namespace gaussmap::detail;

const MapOptions kOptions{0.1, 10, 3, 0.01};  // options of the seeds in corpus/tile

template <int D>
void decode(std::string_view bytes) {
  try {
    const Tile<D> tile = decodeTile<D>(bytes, {}, kOptions);
    if (tile.keys.size() != tile.counts.size()) std::abort();
    encodeTile<D>(tile, {}, kOptions, 1);
  } catch (const std::runtime_error&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  std::string frame(ZSTD_compressBound(size), '\0');
  frame.resize(ZSTD_compress(frame.data(), frame.size(), data, size, 1));
  for (const std::string_view tried : {bytes, std::string_view(frame)}) {
    decode<3>(tried);
    decode<2>(tried);
  }
  return 0;
}
