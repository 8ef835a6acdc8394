// SPDX-License-Identifier: BSD-3-Clause
#include "io/files/natural_order.h"

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace gaussmap::detail {
namespace {

bool isDigit(char c) {
  return c >= '0' && c <= '9';
}

/// Takes the digits at the start of `rest` and drops leading zeros. Of two such numbers, the longer one is larger.
std::string_view takeNumber(std::string_view& rest) {
  std::size_t end = 0;
  while (end < rest.size() && isDigit(rest[end])) ++end;
  std::string_view digits = rest.substr(0, end);
  rest.remove_prefix(end);
  digits.remove_prefix(std::min(digits.find_first_not_of('0'), digits.size()));
  return digits;
}

}  // namespace

bool naturalLess(const std::string& a, const std::string& b) {
  std::string_view rest_a = a, rest_b = b;
  while (!rest_a.empty() && !rest_b.empty()) {
    if (isDigit(rest_a.front()) && isDigit(rest_b.front())) {
      const std::string_view number_a = takeNumber(rest_a), number_b = takeNumber(rest_b);
      if (number_a.size() != number_b.size()) return number_a.size() < number_b.size();
      if (number_a != number_b) return number_a < number_b;
    } else {
      if (rest_a.front() != rest_b.front()) return rest_a.front() < rest_b.front();
      rest_a.remove_prefix(1);
      rest_b.remove_prefix(1);
    }
  }
  if (rest_a.empty() != rest_b.empty()) return rest_a.empty();
  return a < b;  // names like 2 and 02, which are equal as numbers
}

}  // namespace gaussmap::detail
