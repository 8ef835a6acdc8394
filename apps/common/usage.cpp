// SPDX-License-Identifier: BSD-3-Clause
#include "common/usage.h"

#include <unistd.h>

#include <algorithm>
#include <set>
#include <system_error>

#include "io/files/text.h"

namespace gaussmap::app {

void checkScale(const std::string& option, int scale, int scales, const std::string& owner) {
  if (scale >= scales)
    throw UsageError(option + " " + std::to_string(scale) + ": " + owner + " has the scales 0 to " +
                     std::to_string(scales - 1));
}

std::string endingOf(const std::filesystem::path& path) {
  return detail::lowerCase(path.extension().string());
}

void requireExtension(const std::filesystem::path& path, const std::string& extension) {
  if (endingOf(path) != extension) throw UsageError(path.string() + ": the name must end in " + extension);
}

void refuseOtherKinds(const std::filesystem::path& path, const std::string& what, const std::vector<std::string>& own) {
  static const std::set<std::string> kinds = {
      ".gmap", ".pcd", ".ply",     ".vtp", ".vtk", ".obj", ".stl", ".las",  ".laz",  ".e57",  ".xyz", ".pts",
      ".bin",  ".svg", ".geojson", ".png", ".jpg", ".pdf", ".csv", ".json", ".yaml", ".yml",  ".txt", ".tum",
      ".log",  ".bag", ".db3",     ".ot",  ".bt",  ".gz",  ".zip", ".zst",  ".html", ".mcap", ".npy", ".npz"};
  const std::string ending = endingOf(path);
  if (kinds.count(ending) == 0 || std::find(own.begin(), own.end(), ending) != own.end()) return;
  throw UsageError(path.string() + ": this output is " + what + ", so its name must not end in " + ending + "; use " +
                   own.front());
}

void checkOutput(const Output& output, const std::vector<std::filesystem::path>& inputs) {
  const std::filesystem::path path = output.path, folder = path.has_parent_path() ? path.parent_path() : ".";
  std::error_code error;
  for (const std::filesystem::path& input : inputs)
    for (const char* const written : {"", ".part"})  // AtomicFile writes to the second name first
      if (std::filesystem::equivalent(output.path + written, input, error))
        throw UsageError(output.path + ": writing it would destroy the input " + input.string() +
                         "; choose another name");
  if (std::filesystem::is_directory(path, error) || !path.has_filename())
    throw UsageError("'" + output.path + "' is a directory: give the name of a file");
  if (!std::filesystem::is_directory(folder, error))
    throw UsageError(output.path + ": the directory " + folder.string() + " does not exist");
  if (access(folder.c_str(), W_OK) != 0)
    throw UsageError(output.path + ": the directory " + folder.string() + " cannot be written to");
  if (std::filesystem::exists(path, error) && !output.force)
    throw UsageError(output.path + " exists already; choose another name or use --force to replace it");
}

void checkMapOutput(const Output& output, const std::vector<std::filesystem::path>& inputs) {
  checkOutput(output, inputs);
  if (endingOf(output.path) == ".pcd")
    throw UsageError(output.path +
                     ": the name of a map file must not end in .pcd; use .gmap (gaussmap export writes PCD files)");
  refuseOtherKinds(output.path, "a map", {".gmap"});
}

void checkOutputs(const std::vector<std::string>& outputs, bool force, const std::vector<std::filesystem::path>& inputs,
                  const std::vector<std::filesystem::path>& taken) {
  std::set<std::filesystem::path> all;
  for (const std::filesystem::path& path : taken) all.insert(std::filesystem::weakly_canonical(path));
  for (const std::string& output : outputs) {
    if (output.empty()) continue;
    if (!all.insert(std::filesystem::weakly_canonical(output)).second)
      throw UsageError(output + " is already another output of this command; choose another name");
    checkOutput({output, force}, inputs);
  }
}

void makeFolder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw UsageError(folder.string() + ": cannot create the directory: " + error.message());
}

}  // namespace gaussmap::app
