// SPDX-License-Identifier: BSD-3-Clause
#include "io/gmap/tile_codec.h"

#include <gtest/gtest.h>
#include <zstd.h>

#include <Eigen/Cholesky>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "gaussmap/core/gaussian.h"

namespace gaussmap {
using namespace detail;

namespace {

const MapOptions kOptions = Grid<3>({0.1, 10, 3, 0.0}).options();
const TileAddress<3> kAddress{1, {-1, 0, 2}, 100};

/// Two cells of coarse Gaussians, two in the first and one in the second.
Tile<3> gaussianTile() {
  Tile<3> tile;
  tile.keys = {{-1, 7, 299}, {-100, 99, 200}};
  tile.counts = {2, 1};
  for (int i = 0; i < 3; ++i) tile.gaussians.push_back({{0.1, -0.2, 0.1 * i}, 0.01 * Matrix<3>::Identity(), 5.0 + i});
  tile.labels = {0, 3, 1};
  return tile;
}

std::string encoded(const Tile<3>& tile) {
  return encodeTile<3>(tile, kAddress, kOptions, 3);
}

/// A tile with moments, of the finest scale.
Tile<3> momentTile() {
  Tile<3> tile;
  tile.keys = {{-1, 7, 299}};
  tile.counts = {1};
  tile.moments.resize(1);
  tile.moments[0].add({100, -200, 300});
  tile.moments[0].add({-32768, 32767, 0});
  tile.labels = {0};
  return tile;
}

/// The columns inside a tile, to be tampered with.
std::string unpack(const std::string& bytes) {
  std::string raw(ZSTD_getFrameContentSize(bytes.data(), bytes.size()), '\0');
  EXPECT_EQ(ZSTD_decompress(raw.data(), raw.size(), bytes.data(), bytes.size()), raw.size());
  return raw;
}

std::string pack(const std::string& raw) {
  std::string bytes(ZSTD_compressBound(raw.size()), '\0');
  bytes.resize(ZSTD_compress(bytes.data(), bytes.size(), raw.data(), raw.size(), 3));
  return bytes;
}

void expectRefused(const std::string& bytes, const std::string& why, const TileAddress<3>& address = kAddress,
                   const MapOptions& options = kOptions) {
  try {
    decodeTile<3>(bytes, address, options);
    ADD_FAILURE() << "taken though: " << why;
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
  }
}

TEST(TileCodec, GivesBackGaussians) {
  const Tile<3> tile = gaussianTile(), got = decodeTile<3>(encoded(tile), kAddress, kOptions);
  EXPECT_EQ(got.keys, tile.keys);
  EXPECT_EQ(got.counts, tile.counts);
  EXPECT_EQ(got.labels, tile.labels);
  EXPECT_TRUE(got.moments.empty());
  ASSERT_EQ(got.gaussians.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(got.gaussians[i].mean, tile.gaussians[i].mean);
    EXPECT_EQ(got.gaussians[i].cov, tile.gaussians[i].cov);
    EXPECT_EQ(got.gaussians[i].weight, tile.gaussians[i].weight);
  }
}

TEST(TileCodec, GivesBackOccupancies) {
  Tile<3> tile = gaussianTile();
  tile.log_odds = {-2.5f, 10.0f, 0.0f};
  EXPECT_EQ(decodeTile<3>(encoded(tile), kAddress, kOptions).log_odds, tile.log_odds);
  EXPECT_TRUE(decodeTile<3>(encoded(gaussianTile()), kAddress, kOptions).log_odds.empty());
  tile.log_odds[1] = std::numeric_limits<float>::quiet_NaN();
  expectRefused(encoded(tile), "occupancy");
}

TEST(TileCodec, GivesBackMoments) {
  const Tile<3> tile = momentTile(), got = decodeTile<3>(encoded(tile), kAddress, kOptions);
  EXPECT_EQ(got.keys, tile.keys);
  EXPECT_EQ(got.moments, tile.moments);
  EXPECT_TRUE(got.gaussians.empty());
}

TEST(TileCodec, TakesATileForNoOther) {
  const std::string bytes = encoded(gaussianTile());
  const auto elsewhere = [](auto&& change) {
    TileAddress<3> address = kAddress;
    change(address);
    return address;
  };
  const char* const why = "another place or another map";
  expectRefused(bytes, why, elsewhere([](auto& a) { a.scale = 0; }));
  expectRefused(bytes, why, elsewhere([](auto& a) { a.tile = {0, -1, 2}; }));
  for (const MapOptions& options : {MapOptions{0.2, 10, 3, 0.005}, MapOptions{0.1, 9, 3, 0.005},
                                    MapOptions{0.1, 10, 4, 0.005}, MapOptions{0.1, 10, 3, 0.006}})
    expectRefused(bytes, why, kAddress, options);
  Tile<2> plane;
  plane.keys = {{-1, 7}};
  plane.counts = {1};
  plane.gaussians.resize(1);
  plane.gaussians[0].weight = 1.0;
  expectRefused(encodeTile<2>(plane, {1, {-1, 0}, 100}, kOptions, 3), why);
}

// In front of the columns stand twelve numbers of eight bytes: 6 = cells, 7 = Gaussians, 8 = flags.
std::string withNumber(std::string raw, std::size_t slot, std::uint64_t number) {
  std::memcpy(&raw[8 * slot], &number, 8);
  return pack(raw);
}

TEST(TileCodec, RefusesFalseCounts) {
  const std::string raw = unpack(encoded(gaussianTile()));
  const char* const why = "its size does not fit its cells";
  for (const std::uint64_t cells : {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{5}, std::uint64_t{4000000000},
                                    std::uint64_t{1} << 60, std::numeric_limits<std::uint64_t>::max()}) {
    expectRefused(withNumber(raw, 6, cells), why);
    expectRefused(withNumber(raw, 7, cells), why);
  }
  expectRefused(withNumber(raw, 8, 3), why);  // moments and labels
  expectRefused(withNumber(raw, 8, 0), why);
  expectRefused(withNumber(raw, 8, 6), why);  // labels and occupancies
  expectRefused(withNumber(raw, 8, 16), "does not know");
  expectRefused(pack(raw + "x"), why);
  expectRefused(pack(raw.substr(0, raw.size() - 1)), why);
  expectRefused(pack(raw.substr(0, 50)), "shorter");
  Tile<3> tile = gaussianTile();
  tile.counts = {1, 1};
  expectRefused(encoded(tile), "do not match");
  tile.counts = {3, 0};
  expectRefused(encoded(tile), "a wrong number of Gaussians");
}

TEST(TileCodec, RefusesBombs) {  // 100 MB of zeros in some kB; and a frame that only says it is large
  const std::string bomb = pack(std::string(100000000, '\0'));
  ASSERT_LT(bomb.size(), 20000u);
  expectRefused(bomb, "not a compressed tile");
  std::string liar = pack("abcdefgh");
  ASSERT_EQ(liar[4], '\x20');  // a frame whose content size is one byte: let it have eight
  liar = liar.substr(0, 4) + '\xE0' + std::string("\xff\xff\xff\xff\xff\xff\x00\x00", 8) + liar.substr(6);
  expectRefused(liar, "not a compressed tile");
  expectRefused("", "not a compressed tile");
  expectRefused("not zstd at all", "not a compressed tile");
}

TEST(TileCodec, RefusesCellsOutsideTheirTile) {
  Tile<3> tile = gaussianTile();
  tile.keys[0] = {0, 7, 299};
  expectRefused(encoded(tile), "a cell lies outside");
  tile.keys[0] = {-101, 7, 299};
  expectRefused(encoded(tile), "a cell lies outside");
}

TEST(TileCodec, RefusesGaussiansThatAreNone) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  const auto spoilt = [](auto&& spoil) {
    Tile<3> tile = gaussianTile();
    spoil(tile.gaussians[1]);
    return encoded(tile);
  };
  for (const int axis : {0, 1, 2}) {
    expectRefused(spoilt([&](Gaussian<3>& g) { g.mean(axis) = nan; }), "not finite");
    expectRefused(spoilt([&](Gaussian<3>& g) { g.cov(axis, axis) = nan; }), "not positive definite");
    expectRefused(spoilt([&](Gaussian<3>& g) { g.cov(axis, axis) = 0.0; }), "not positive definite");
    expectRefused(spoilt([&](Gaussian<3>& g) { g.cov(axis, axis) = -1.0; }), "not positive definite");
  }
  expectRefused(spoilt([&](Gaussian<3>& g) { g.weight = infinity; }), "not finite");
  expectRefused(spoilt([&](Gaussian<3>& g) { g.weight = nan; }), "not finite");
}

TEST(TileCodec, RefusesMomentsThatNoPointsHave) {
  const auto spoilt = [](auto&& spoil) {
    Tile<3> tile = momentTile();
    spoil(tile.moments[0]);
    return encoded(tile);
  };
  expectRefused(spoilt([](CellMoments<3>& m) { m.count = 0; }), "impossible count");
  expectRefused(spoilt([](CellMoments<3>& m) { m.count = -1; }), "impossible count");
  expectRefused(spoilt([](CellMoments<3>& m) { m.count = std::int64_t{1} << 33; }), "impossible count");
  expectRefused(spoilt([](CellMoments<3>& m) { m.sum[2] = 65537; }), "outside");
  expectRefused(spoilt([](CellMoments<3>& m) { m.sum[0] = std::numeric_limits<std::int64_t>::min(); }), "outside");
  expectRefused(spoilt([](CellMoments<3>& m) { m.product[5] = std::int64_t{1} << 40; }), "outside");
  expectRefused(spoilt([](CellMoments<3>& m) { m.product[0] = 0; }), "not positive definite");
}

/// A finished tile, its columns, and what comes of changing them.
TEST(TileCodec, GivesBackOrRefusesFinishedTiles) {
  Tile<3> tile = gaussianTile();
  tile.log_odds = {-2.5f, 10.0f, 0.0f};
  const std::string bytes = encodeTile<3>(tile, kAddress, kOptions, 3, Precision::Finished);
  const Tile<3> got = decodeTile<3>(bytes, kAddress, kOptions);
  EXPECT_EQ(got.keys, tile.keys);
  EXPECT_EQ(got.counts, tile.counts);
  EXPECT_EQ(got.labels, tile.labels);
  EXPECT_EQ(got.log_odds, tile.log_odds);  // multiples of 1 / 16
  EXPECT_TRUE(got.gaussians[1].mean.isApprox(tile.gaussians[1].mean, 0.05));
  EXPECT_EQ(decodeTile<3>(encodeTile<3>(momentTile(), kAddress, kOptions, 3, Precision::Finished), kAddress, kOptions)
                .moments.size(),
            0u);
  const std::string raw = unpack(bytes);
  for (const std::uint64_t number :
       {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{4000000000}, std::numeric_limits<std::uint64_t>::max()})
    for (const std::size_t slot : {6, 7})
      EXPECT_THROW(decodeTile<3>(withNumber(raw, slot, number), kAddress, kOptions), std::runtime_error);
  for (const std::uint64_t flags : {8, 9, 10, 12, 15, 24})  // 14 is right
    EXPECT_THROW(decodeTile<3>(withNumber(raw, 8, flags), kAddress, kOptions), std::runtime_error);
  expectRefused(pack(raw + "x"), "its size does not fit");
  expectRefused(pack(raw.substr(0, raw.size() - 1)), "shorter");
  Random random(3);
  for (int round = 0; round < 20000; ++round) {  // whatever comes, it is a Gaussian
    std::string changed = raw;
    for (std::uint64_t change = 1 + random.below(3); change > 0; --change)
      changed[96 + random.below(raw.size() - 96)] = static_cast<char>(random.below(256));
    try {
      for (const Gaussian<3>& gaussian : decodeTile<3>(pack(changed), kAddress, kOptions).gaussians) {
        EXPECT_TRUE(gaussian.mean.allFinite() && gaussian.weight > 0.0);
        EXPECT_EQ(Eigen::LLT<Matrix<3>>(gaussian.cov).info(), Eigen::Success);
      }
    } catch (const std::runtime_error&) {
    }
  }
}

TEST(TileCodec, RefusesFinishedBombs) {
  const std::string raw = unpack(encodeTile<3>(gaussianTile(), kAddress, kOptions, 3, Precision::Finished));
  EXPECT_THROW(decodeTile<3>(withNumber(raw + std::string(10000000, '\0'), 7, 1000000), kAddress, kOptions),
               std::runtime_error);
  expectRefused(withNumber(raw + std::string(20 * raw.size(), '\0'), 7, raw.size()), "its size does not fit its cells");
}

}  // namespace
}  // namespace gaussmap
