// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace gaussmap::detail {

/// The coordinate reference system (CRS) of a LAS file.
struct LasCrs {
  std::string text;              ///< WKT, or for example "EPSG:26915 (NAD83 / UTM zone 15N)"; empty: unknown
  bool is_geographic = false;    ///< x and y are degrees of longitude and latitude
  double horizontal_unit = 1.0;  ///< unit of x and y [m]; 1 if it is unknown or if x and y are degrees
  double vertical_unit = 1.0;    ///< unit of z [m]; that of x and y if the CRS does not say it
};

/// Returns what a CRS in WKT, version 1 or 2, says about the coordinates. Text that is not WKT is kept as it is.
LasCrs crsOfWkt(std::string_view wkt);

/// Returns what the GeoTIFF keys of a LAS file say: the bytes of the VLR 34735, and those of 34737 with the names.
/// Keys that are damaged count as missing.
LasCrs crsOfGeoKeys(std::string_view directory, std::string_view names);

}  // namespace gaussmap::detail
