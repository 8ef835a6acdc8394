// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "gaussmap/core/error.h"
#include "gaussmap/core/gaussian.h"

// Checks that a reader either reads a file or refuses it with one FileError, whatever its bytes are.
namespace gaussmap::test {

/// Returns the message of the FileError that the action throws, or "" if it throws nothing.
template <typename Action>
std::string complaintOf(const Action& action) {
  try {
    action();
    return "";
  } catch (const FileError& error) {
    return error.what();
  }
}

/// Expects a message that begins with the name of the file and contains every piece.
inline void expectComplaint(const std::string& complaint, const std::filesystem::path& path,
                            const std::vector<std::string>& pieces) {
  EXPECT_EQ(complaint.rfind(path.string() + ": ", 0), 0u) << complaint;
  for (const std::string& piece : pieces)
    EXPECT_NE(complaint.find(piece), std::string::npos) << piece << " in: " << complaint;
}

/// Returns the bytes after one to three changes: cut off, a byte or a bit changed, a character inserted, bytes removed.
inline std::string mutated(std::string bytes, Random& random) {
  const auto below = [&random](std::size_t n) { return static_cast<std::size_t>(random.below(n)); };
  for (std::size_t change = 1 + below(3); change > 0 && !bytes.empty(); --change) {
    const std::size_t place = below(bytes.size());
    switch (below(5)) {
      case 0:
        bytes.resize(place);
        break;
      case 1:
        bytes[place] = static_cast<char>(below(256));
        break;
      case 2:
        bytes[place] = static_cast<char>(bytes[place] ^ (1 << below(8)));
        break;
      case 3:
        bytes.insert(place, 1, "0123456789 \n-.eE"[below(16)]);
        break;
      default:
        bytes.erase(place, 1 + below(8));
    }
  }
  return bytes;
}

/// Calls `read` with thousands of mutations of good files. The test fails if `read` throws anything except a FileError,
/// or if it refuses few or all of them.
template <typename Read>
void expectMutationsReadOrRefused(const std::vector<std::string>& good, const Read& read) {
  constexpr int kRounds = 6000;
  Random random(3);
  int refused = 0;
  for (int round = 0; round < kRounds; ++round) {
    const std::string bytes = mutated(good[random.below(good.size())], random);
    refused += !complaintOf([&] { read(bytes); }).empty();
  }
  EXPECT_GT(refused, kRounds / 3);
  EXPECT_LT(refused, kRounds);
}

}  // namespace gaussmap::test
