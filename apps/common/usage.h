// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace gaussmap::app {

/// Wrong usage of the command line: exit code 2. Every other error has exit code 1.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Throws UsageError if the map does not have the scale. `option` (such as "--scale") and `owner` are named in the
/// message.
void checkScale(const std::string& option, int scale, int scales, const std::string& owner = "the map");

/// Returns the extension of a file in lower case, such as ".pcd"; empty if there is none.
std::string endingOf(const std::filesystem::path& path);
/// Throws UsageError unless the path has this extension, such as ".pcd". Capital letters count as small ones.
void requireExtension(const std::filesystem::path& path, const std::string& extension);
/// Throws UsageError if the extension of an output is that of another kind of file. `own` has the extensions of its own
/// kind, and `what` names the kind: "a table (CSV)". An empty path is skipped.
void refuseOtherKinds(const std::filesystem::path& path, const std::string& what, const std::vector<std::string>& own);

/// An output file, and whether it may replace an existing one.
struct Output {
  std::string path;
  bool force = false;
};

/// Throws UsageError if the output is one of the inputs, is a directory, or exists without --force, or if its directory
/// does not exist or is not writable. Commands call it before they start to work.
void checkOutput(const Output& output, const std::vector<std::filesystem::path>& inputs = {});
/// The same for a map file, whose name must not have the extension of another kind of file.
void checkMapOutput(const Output& output, const std::vector<std::filesystem::path>& inputs);
/// The same for several outputs of one command. They must differ from each other and from those in `taken`. Empty names
/// are skipped.
void checkOutputs(const std::vector<std::string>& outputs, bool force, const std::vector<std::filesystem::path>& inputs,
                  const std::vector<std::filesystem::path>& taken = {});

/// Creates the directory if it does not exist. Throws UsageError if that fails.
void makeFolder(const std::filesystem::path& folder);

}  // namespace gaussmap::app
