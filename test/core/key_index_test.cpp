// SPDX-License-Identifier: BSD-3-Clause
#include "core/key_index.h"
#include "gaussmap/map/grid.h"

#include <gtest/gtest.h>

#include <map>

#include "gaussmap/core/gaussian.h"

namespace gaussmap {
using namespace detail;

namespace {

using Key = CellKey<3>;

TEST(KeyIndex, FindsWhatAMapFindsWhateverIsInsertedAndErased) {
  Random random(7);
  std::vector<Key> keys;  // by index
  std::map<Key, std::uint32_t> twin;
  KeyIndex index;
  const auto find = [&](const Key& key) {
    return index.find(KeyIndex::hashOf(key), [&](std::uint32_t i) { return keys[i] == key; });
  };
  for (int step = 0; step < 20000; ++step) {
    const auto coordinate = [&] { return static_cast<std::int32_t>(random.bits() % 12) - 6; };
    const Key key = {coordinate(), coordinate(), coordinate()};
    const auto known = twin.find(key);
    ASSERT_EQ(find(key), known == twin.end() ? KeyIndex::kNone : known->second);
    if (known == twin.end()) {
      const auto i = static_cast<std::uint32_t>(keys.size());
      keys.push_back(key);
      index.insert(KeyIndex::hashOf(key), i);
      twin.emplace(key, i);
    } else {
      index.erase(KeyIndex::hashOf(key), known->second);
      twin.erase(known);
    }
    ASSERT_EQ(index.size(), twin.size());
  }
  for (const auto& [key, i] : twin) EXPECT_EQ(find(key), i);
}

TEST(KeyIndex, FindsAllOfManyKeysWithTheSameHash) {
  KeyIndex index;
  for (std::uint32_t i = 0; i < 100; ++i) index.insert(42, i);
  for (std::uint32_t i = 0; i < 100; i += 2) index.erase(42, i);
  for (std::uint32_t i = 0; i < 100; ++i)
    EXPECT_EQ(index.find(42, [&](std::uint32_t found) { return found == i; }), i % 2 ? i : KeyIndex::kNone);
}

TEST(KeyIndex, DoesNotGrowWhenTheSameNumberComesAndGoes) {
  KeyIndex index;
  for (std::uint32_t i = 0; i < 1000; ++i) index.insert(i * 2654435761u, i);
  const std::size_t bytes = index.memoryBytes();
  for (std::uint32_t i = 1000; i < 100000; ++i) {
    index.erase((i - 1000) * 2654435761u, i - 1000);
    index.insert(i * 2654435761u, i);
  }
  EXPECT_EQ(index.memoryBytes(), bytes);
}

}  // namespace
}  // namespace gaussmap
