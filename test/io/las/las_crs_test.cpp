// SPDX-License-Identifier: BSD-3-Clause
#include "io/las/las_crs.h"

#include <gtest/gtest.h>

#include <string>

#include "io/las/las_builder.h"

namespace gaussmap {
namespace {

using detail::crsOfGeoKeys;
using detail::crsOfWkt;

const std::string kDegrees =
    "GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\",6378137,298.25]],UNIT[\"degree\",0.017]]";
const std::string kFeet = "PROJCS[\"x\"," + kDegrees + ",PROJECTION[\"TM\"],UNIT[\"foot\",0.3048],AXIS[\"X\",EAST]]";

TEST(LasCrs, WktOfVersion1) {
  EXPECT_TRUE(crsOfWkt(kDegrees).is_geographic);
  EXPECT_EQ(crsOfWkt(kDegrees).horizontal_unit, 1.0);
  EXPECT_FALSE(crsOfWkt(kFeet).is_geographic);
  EXPECT_EQ(crsOfWkt(kFeet).horizontal_unit, 0.3048);
  EXPECT_EQ(crsOfWkt(kFeet).vertical_unit, 0.3048);
  const auto both =
      crsOfWkt("COMPD_CS[\"both\"," + kFeet + ",VERT_CS[\"height\",VERT_DATUM[\"d\",2005],UNIT[\"metre\",1.0]]]");
  EXPECT_FALSE(both.is_geographic);
  EXPECT_EQ(both.horizontal_unit, 0.3048);
  EXPECT_EQ(both.vertical_unit, 1.0);
  EXPECT_TRUE(
      crsOfWkt("COMPD_CS[\"GEOGCS, not PROJCS[\"," + kDegrees + ",VERT_CS[\"h\",UNIT[\"m\",1]]]").is_geographic);
  EXPECT_FALSE(crsOfWkt("GEOCCS[\"earth\",DATUM[\"d\"],UNIT[\"metre\",1]]").is_geographic);
  EXPECT_FALSE(crsOfWkt("LOCAL_CS[\"site\",UNIT[\"metre\",1]]").is_geographic);
}

TEST(LasCrs, WktOfVersion2) {
  const std::string axes =
      "CS[ellipsoidal,2],AXIS[\"latitude\",north],AXIS[\"longitude\",east],ANGLEUNIT[\"degree\",0.0174]";
  EXPECT_TRUE(
      crsOfWkt("GEOGCRS[\"WGS 84\",DATUM[\"d\",ELLIPSOID[\"e\",6378137,298,LENGTHUNIT[\"metre\",1]]]," + axes + "]")
          .is_geographic);
  EXPECT_TRUE(crsOfWkt("GEODCRS[\"WGS 84\"," + axes + "]").is_geographic);
  EXPECT_FALSE(crsOfWkt("GEODCRS[\"WGS 84\",CS[Cartesian,3],LENGTHUNIT[\"metre\",1]]").is_geographic);
  EXPECT_TRUE(
      crsOfWkt("BOUNDCRS[SOURCECRS[GEOGCRS[\"WGS 84\"," + axes + "]],TARGETCRS[PROJCRS[\"x\"]]]").is_geographic);
  const auto projected = crsOfWkt(
      "PROJCRS[\"x\",BASEGEOGCRS[\"WGS 84\",DATUM[\"d\",ELLIPSOID[\"e\",6378137,298,LENGTHUNIT[\"metre\",1]]]],"
      "CONVERSION[\"c\",PARAMETER[\"False easting\",500000,LENGTHUNIT[\"metre\",1]]],CS[Cartesian,2],"
      "AXIS[\"easting\",east,LENGTHUNIT[\"US survey foot\",0.304800609601219]],AXIS[\"northing\",north]]");
  EXPECT_FALSE(projected.is_geographic);
  EXPECT_EQ(projected.horizontal_unit, 0.304800609601219);
}

TEST(LasCrs, TextThatIsNotWktIsKept) {
  EXPECT_EQ(crsOfWkt(std::string("EPSG:25832\0rest", 15)).text, "EPSG:25832");
  for (const std::string text : {"", "[", "]]]", "UNIT[1,2]", "PROJCS[\"never closed", "((((", "PROJCS[UNIT[,nan]]"}) {
    EXPECT_EQ(crsOfWkt(text).text, text);
    EXPECT_EQ(crsOfWkt(text).horizontal_unit, 1.0) << text;
  }
  EXPECT_FALSE(crsOfWkt(std::string(100000, '[')).is_geographic);
}

TEST(LasCrs, GeoTiffKeys) {
  const std::string names = "WGS 84 / UTM zone 17N|WGS 84|";
  const auto utm = crsOfGeoKeys(
      test::geoKeys({{1024, 0, 1, 1}, {1026, 34737, 22, 0}, {3072, 0, 1, 32617}, {3076, 0, 1, 9001}}), names);
  EXPECT_EQ(utm.text, "EPSG:32617 (WGS 84 / UTM zone 17N)");
  EXPECT_FALSE(utm.is_geographic);
  const auto degrees = crsOfGeoKeys(test::geoKeys({{1024, 0, 1, 2}, {2048, 0, 1, 4326}, {2049, 34737, 7, 22}}), names);
  EXPECT_EQ(degrees.text, "EPSG:4326 (WGS 84)");
  EXPECT_TRUE(degrees.is_geographic);
  EXPECT_TRUE(crsOfGeoKeys(test::geoKeys({{2048, 0, 1, 4326}}), "").is_geographic);
  const auto feet = crsOfGeoKeys(
      test::geoKeys(
          {{1024, 0, 1, 1}, {3072, 0, 1, 32767}, {3073, 34737, 4, 0}, {3076, 0, 1, 9003}, {4099, 0, 1, 9001}}),
      "Site|");
  EXPECT_EQ(feet.text, "Site");
  EXPECT_EQ(feet.horizontal_unit, 1200.0 / 3937.0);
  EXPECT_EQ(feet.vertical_unit, 1.0);
}

TEST(LasCrs, DamagedGeoTiffKeysCountAsMissing) {
  EXPECT_EQ(crsOfGeoKeys("", "").text, "");
  EXPECT_EQ(crsOfGeoKeys("abc", "").text, "");
  EXPECT_EQ(crsOfGeoKeys(test::geoKeys({{3072, 0, 1, 32617}}).substr(0, 15), "").text, "");
  EXPECT_EQ(crsOfGeoKeys(test::geoKeys({{3073, 34737, 60000, 60000}}), "name|").text, "");
  EXPECT_EQ(crsOfGeoKeys(test::geoKeys({{3073, 34737, 60000, 2}}), "name|").text, "me");
}

}  // namespace
}  // namespace gaussmap
