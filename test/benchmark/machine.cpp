// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cstdint>
#include <thread>

#include "measure.h"
#include "parts.h"

namespace gaussmap::benchmark {
namespace {

/// Eight chains at once: as much as one core can do.
double shiftAndXor() {
  std::array<std::uint64_t, 8> state = {1, 2, 3, 4, 5, 6, 7, 8};
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

template <typename Work>
double twice(const Work& work, int threads) {
  double other = 0.0;
  if (threads == 1) {
    other = work();
    return other + work();
  }
  std::thread second([&] { other = work(); });
  const double own = work();
  second.join();
  return own + other;
}

template <typename Work>
void measure(const char* name, const Work& work, int runs, Table& table) {
  const std::vector<Measured> of =
      measureInTurn({[&] { return twice(work, 2); }, [&] { return twice(work, 1); }}, runs);
  table.add(Row{"this machine", name, 2, of[0].seconds, 0.0, "one thread", of[1].seconds, 0.0, 0.0});
}

}  // namespace

void measureMachine(int runs, Table& table) {
  measure("sums in registers", shiftAndXor, runs, table);
  const std::vector<std::uint64_t> numbers(std::size_t{1} << 25, 1);
  measure(
      "reading 256 MB", [&] { return sumOf(numbers); }, runs, table);
}

}  // namespace gaussmap::benchmark
