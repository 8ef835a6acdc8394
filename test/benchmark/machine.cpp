// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cstdint>
#include <thread>
#include <vector>

#include "measure.h"
#include "parts.h"

namespace gaussmap::benchmark {
namespace {

/// Computes eight chains that are independent of each other.
double shiftAndXor(std::uint64_t seed) {
  std::array<std::uint64_t, 8> state = {};
  for (std::uint64_t& s : state) s = ++seed;
  for (int i = 0; i < 30000000; ++i)
    for (std::uint64_t& s : state) {
      s ^= s << 13;
      s ^= s >> 7;
      s ^= s << 17;
    }
  std::uint64_t all = 0;
  for (const std::uint64_t s : state) all ^= s;
  return static_cast<double>(all);
}

double sumOf(const std::vector<std::uint64_t>& numbers) {
  std::uint64_t sum = 0;
  for (const std::uint64_t number : numbers) sum += number;
  return static_cast<double>(sum);
}

/// Runs work(0) and work(1), one after the other or at the same time.
template <typename Work>
double both(const Work& work, int threads) {
  if (threads == 1) return work(0) + work(1);
  double other = 0.0;
  std::thread second([&] { other = work(1); });
  const double own = work(0);
  second.join();
  return own + other;
}

template <typename Work>
void measure(const char* name, const Work& work, int runs, Table& table) {
  const std::vector<Measured> of = measureInTurn({[&] { return both(work, 2); }, [&] { return both(work, 1); }}, runs);
  table.add(Row{"this machine", name, 2, of[0].seconds, 0.0, "one thread", of[1].seconds, 0.0});
}

}  // namespace

void measureMachine(int runs, Table& table) {
  measure(
      "sums in registers", [](std::uint64_t part) { return shiftAndXor(100 * part); }, runs, table);
  const std::vector<std::uint64_t> numbers[2] = {std::vector<std::uint64_t>(std::size_t{1} << 25, 1),
                                                 std::vector<std::uint64_t>(std::size_t{1} << 25, 2)};
  measure(
      "reading 512 MB", [&](std::size_t part) { return sumOf(numbers[part]); }, runs, table);
}

}  // namespace gaussmap::benchmark
