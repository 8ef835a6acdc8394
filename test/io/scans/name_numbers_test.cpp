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

TEST(NameNumbers, KeepTheFractionOfATimeWithSomethingBehindIt) {
  const std::vector<std::int64_t> expected = {1700000000500000000, 1700000001250000000};
  for (const std::string behind : {"_cloud.pcd", "-cloud.pcd", "_lidar1.pcd", "s.pcd", ".cloud.pcd", "_raw.pcd.gz",
                                   "_0.pcd", "/cloud.pcd", "_v2/cloud.pcd"}) {
    EXPECT_EQ(timesOf({"1700000000.500000" + behind, "1700000001.250000" + behind}), expected) << behind;
    EXPECT_EQ(timesOf({"cloud_1700000000.5" + behind, "cloud_1700000001.25" + behind}), expected) << behind;
    EXPECT_EQ(timesOf({"1700000000_500000000" + behind, "1700000001_250000000" + behind}), expected) << behind;
  }
}

TEST(NameNumbers, ReadSecondsSinceTheStart) {
  const std::vector<std::int64_t> expected = {100000000, 600000000, 1100000000};
  EXPECT_EQ(timesOf({"0.100000000.pcd", "0.600000000.pcd", "1.100000000.pcd"}), expected);
  EXPECT_EQ(timesOf({"0_100000000.pcd", "0_600000000.pcd", "1_100000000.pcd"}), expected);
  EXPECT_EQ(timesOf({"cloud_0_100000000_raw.pcd", "cloud_0_600000000_raw.pcd", "cloud_1_100000000_raw.pcd"}), expected);
  EXPECT_EQ(timesOf({"1234_600000000.pcd", "1235_5000000.pcd"}),
            (std::vector<std::int64_t>{1234600000000, 1235005000000}));  // not padded
  EXPECT_EQ(timesOf({"5.600000000.pcd"}), std::vector<std::int64_t>{5600000000});
  EXPECT_TRUE(timesOf({"drive_11_frame_3.pcd", "drive_12_frame_4.pcd"}).empty());
  EXPECT_TRUE(timesOf({"12_100.pcd", "13_200.pcd"}).empty());
}

TEST(NameNumbers, ReadTimesBehindOtherNumbers) {
  const std::vector<std::int64_t> expected = {1700000000000000000, 1700000001000000000};
  EXPECT_EQ(timesOf({"v2.1700000000.pcd", "v2.1700000001.pcd"}), expected);
  EXPECT_EQ(timesOf({"7.1700000000000.pcd", "8.1700000001000.pcd"}), expected);
  EXPECT_EQ(timesOf({"000007_1700000000000.pcd", "000008_1700000001000.pcd"}), expected);
}

TEST(NameNumbers, ReadDatesAsUtc) {
  const std::vector<std::int64_t> expected = {1700000000000000000, 1700000000500000000, 1700000061250000000};
  const struct {
    const char *first, *second, *third;
  } names[] = {
      {"2023-11-14_22-13-20.0.pcd", "2023-11-14_22-13-20.5.pcd", "2023-11-14_22-14-21.25.pcd"},
      {"20231114T221320.000.pcd", "20231114T221320.500.pcd", "20231114T221421.250.pcd"},
      {"scan_20231114_221320_000_a.pcd", "scan_20231114_221320_500_a.pcd", "scan_20231114_221421_250_a.pcd"},
      {"2023_11_14_22_13_20_000000.pcd", "2023_11_14_22_13_20_500000.pcd", "2023_11_14_22_14_21_250000.pcd"},
      {"20231114221320000.pcd", "20231114221320500.pcd", "20231114221421250.pcd"},
      {"20231114_221320000.pcd", "20231114_221320500.pcd", "20231114_221421250.pcd"},
  };
  for (const auto& [first, second, third] : names) {
    EXPECT_EQ(timesOf({first, second, third}), expected) << first;
    EXPECT_TRUE(numbersIn({first, second, third}).dates);
    EXPECT_TRUE(numbersIn({first, second, third}).indices.empty()) << first;
  }
  EXPECT_EQ(timesOf({"2024-02-29-12-00-00.pcd", "2024-03-01-00-00-00.pcd"}),
            (std::vector<std::int64_t>{1709208000000000000, 1709251200000000000}));
}

TEST(NameNumbers, TakeOneDateOfAllNamesForTheNameOfTheLog) {
  const NameNumbers numbers = numbersIn({"20231114_221320_000.pcd", "20231114_221320_001.pcd"});
  EXPECT_TRUE(numbers.times.empty());
  EXPECT_EQ(numbers.indices, (std::vector<std::uint64_t>{0, 1}));
  EXPECT_EQ(timesOf({"20231114_221320_1700000000.5.pcd", "20231114_221320_1700000001.5.pcd"}),
            (std::vector<std::int64_t>{1700000000500000000, 1700000001500000000}));
  EXPECT_FALSE(numbersIn({"20239914_221320.pcd", "20239914_221321.pcd"}).dates);  // no such month
  EXPECT_FALSE(numbersIn({"20230229_221320.pcd", "20230229_221321.pcd"}).dates);  // no such day in 2023
  EXPECT_TRUE(numbersIn({"20240229_221320.pcd", "20240229_221321.pcd"}).dates);
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
}

}  // namespace
}  // namespace gaussmap::detail
