// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "gaussmap/core/scans.h"
#include "io/e57/e57_description.h"
#include "io/e57/e57_pages.h"
#include "io/e57/e57_section.h"
#include "io/e57/e57_values.h"

namespace gaussmap::detail {

/// An open E57 file. It does not change after opening.
struct E57Contents {
  explicit E57Contents(const std::filesystem::path& path) : pages(path) {}

  E57Pages pages;
  E57Description description;
  std::vector<E57Section> sections;         ///< one per scan
  std::vector<E57Coordinates> coordinates;  ///< one per scan
};

/// Reads the points of a scan of an E57 file. The first read() joins the bytes of the coordinates from the packets;
/// each read() decodes its block.
class E57ScanReader : public ScanReader {
 public:
  E57ScanReader(std::shared_ptr<const E57Contents> contents, std::size_t scan)
      : contents_(std::move(contents)), number_(scan) {}

  std::size_t size() const override { return static_cast<std::size_t>(scan().points); }
  void read(std::size_t first, PointBlock<3>& block) const override;
  void requireWhole() const override { contents_->pages.requireWhole(); }
  std::vector<std::string> valueNames() const override;
  std::vector<double> values(const std::string& name) const override;

 private:
  const E57Scan& scan() const { return contents_->description.scans[number_]; }
  void load() const;
  void decode(std::size_t field, const E57Stream& stream, std::size_t first, std::size_t count, double* values) const;
  std::vector<E57Stream> streamsOf(const std::vector<std::size_t>& fields) const;
  std::vector<double> decodeValue(const E57Value& value) const;

  std::shared_ptr<const E57Contents> contents_;
  std::size_t number_;
  mutable std::mutex mutex_;
  mutable std::atomic<bool> is_loaded_{false};
  mutable std::vector<E57Stream> streams_;  // three coordinates, and the invalid state if there is one
};

}  // namespace gaussmap::detail
