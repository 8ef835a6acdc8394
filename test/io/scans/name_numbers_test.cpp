// SPDX-License-Identifier: BSD-3-Clause
#include "io/scans/name_numbers.h"

#include <gtest/gtest.h>

namespace gaussmap::detail {
namespace {

using Strings = std::vector<std::string>;

/// The times in the names [ns].
std::vector<std::int64_t> timesOf(const Strings& names) {
  const NameNumbers numbers = numbersIn(names);
  std::vector<std::int64_t> times;
  for (const Decimal& time : numbers.times)
    times.push_back(toTime(time, unitByMagnitude(largestOf(numbers.times))).value().count());
  return times;
}

TEST(Decimal, KeepsAllDigitsOfATime) {
  EXPECT_EQ(toTime(*parseDecimal("1700000000.123456789"), TimeUnit::Seconds)->count(), 1700000000123456789);
  EXPECT_EQ(toTime(*parseDecimal("1.700000000123456789e+09"), TimeUnit::Seconds)->count(), 1700000000123456789);
  EXPECT_EQ(toTime(*parseDecimal("1700000000123456789"), TimeUnit::Nanoseconds)->count(), 1700000000123456789);
  EXPECT_EQ(toTime(*parseDecimal("1700000000123.4567891"), TimeUnit::Milliseconds)->count(), 1700000000123456789);
  EXPECT_EQ(toTime(*parseDecimal("-0.5"), TimeUnit::Seconds)->count(), -500000000);
  EXPECT_EQ(toTime(*parseDecimal("0.0000000004"), TimeUnit::Seconds)->count(), 0);
  EXPECT_EQ(timeText(Instant(1700000000000000500)), "1700000000.0000005 s");
}

TEST(Decimal, RefusesWhatIsNoFiniteNumber) {
  for (const char* const word : {"", ".", "-", "1.2.3", "nan", "inf", "1e", "0x10", "1 2", "1e99999"})
    EXPECT_FALSE(parseDecimal(word)) << word;
  EXPECT_FALSE(toTime(*parseDecimal("1e30"), TimeUnit::Seconds));
}

TEST(NameNumbers, ReadTimesInEveryUnit) {
  EXPECT_EQ(timesOf({"1700000000.5.pcd", "1700000001.25.pcd"}),
            (std::vector<std::int64_t>{1700000000500000000, 1700000001250000000}));
  EXPECT_EQ(timesOf({"1700000000500.pcd", "1700000001250.pcd"}),
            (std::vector<std::int64_t>{1700000000500000000, 1700000001250000000}));
  EXPECT_EQ(timesOf({"1700000000500000.pcd", "1700000001250000.pcd"}),
            (std::vector<std::int64_t>{1700000000500000000, 1700000001250000000}));
  EXPECT_EQ(timesOf({"1700000000500000007.pcd", "1700000001250000009.pcd"}),
            (std::vector<std::int64_t>{1700000000500000007, 1700000001250000009}));
}

TEST(NameNumbers, ReadSecondsAndNanoseconds) {
  const std::vector<std::int64_t> expected = {1700000000000000900, 1700000001123456789};
  EXPECT_EQ(timesOf({"lidar_1700000000_000000900.pcd", "lidar_1700000001_123456789.pcd"}), expected);
  EXPECT_EQ(timesOf({"1700000000_900.pcd", "1700000001_123456789.pcd"}), expected);
  EXPECT_EQ(timesOf({"1700000000.900.pcd", "1700000001.123456789.pcd"}), expected);  // not padded
  EXPECT_EQ(timesOf({"1700000000,000000900.pcd", "1700000001,123456789.pcd"}), expected);
}

TEST(NameNumbers, ReadFractionsAsDecimals) {
  EXPECT_EQ(timesOf({"1700000000.9.pcd", "1700000001.1234.pcd"}),
            (std::vector<std::int64_t>{1700000000900000000, 1700000001123400000}));
  EXPECT_EQ(timesOf({"1700000000_900000_front.pcd", "1700000001_000001_front.pcd"}),
            (std::vector<std::int64_t>{1700000000900000000, 1700000001000001000}));
  EXPECT_EQ(timesOf({"scan_0.50.pcd", "scan_12.25.pcd"}), (std::vector<std::int64_t>{500000000, 12250000000}));
}

TEST(NameNumbers, ReadTheNumberThatDiffers) {
  EXPECT_EQ(numbersIn({"000007.pcd", "000012.PCD"}).indices, (std::vector<std::uint64_t>{7, 12}));
  EXPECT_EQ(numbersIn({"0000000007.pcd.gz"}).indices, std::vector<std::uint64_t>{7});
  EXPECT_EQ(numbersIn({"drive_0011_frame3_v2.pcd", "drive_0011_frame4_v2.pcd"}).indices,
            (std::vector<std::uint64_t>{3, 4}));
  EXPECT_EQ(numbersIn({"3_1700000000.5.pcd", "4_1700000001.5.pcd"}).indices, (std::vector<std::uint64_t>{3, 4}));
  EXPECT_TRUE(numbersIn({"000007.pcd", "000012.pcd"}).times.empty());
}

TEST(NameNumbers, FindNothingWhereNamesHaveNothing) {
  for (const Strings& names :
       {Strings{}, Strings{"a.pcd", "b.pcd"}, Strings{"a1.pcd", "b.pcd"}, Strings{"1.pcd", "1.pcd"}}) {
    EXPECT_TRUE(numbersIn(names).indices.empty());
    EXPECT_TRUE(numbersIn(names).times.empty());
  }
  EXPECT_TRUE(numbersIn({"20230710_143000.pcd", "20230710_143001.pcd"}).times.empty());  // a date is no time
}

}  // namespace
}  // namespace gaussmap::detail
