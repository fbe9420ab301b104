// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "file/descriptor.hpp"

namespace kelpie::file {

/// The output folder of a run, claimed before the work begins: obstacles to writing show at once,
/// and no second run writes into the folder. The lock file `.kelpie.lock` is removed at the end;
/// the lock file of a killed process has no effect. (Without file locks, second runs are not
/// noticed.)
class OutFolder {
 public:
  /// Makes the folder if missing, and removes temporary files of `names` (the files to write) left
  /// by killed processes. Throws InputError if another run holds the folder, Failure if the folder
  /// or a file cannot be written.
  OutFolder(std::filesystem::path folder, const std::vector<std::string>& names);
  /// Removes an empty folder made by the constructor.
  ~OutFolder();
  OutFolder(const OutFolder&) = delete;
  OutFolder& operator=(const OutFolder&) = delete;

  const std::filesystem::path& path() const { return folder_; }

 private:
  explicit OutFolder(std::filesystem::path folder);
  void take();

  std::filesystem::path folder_;
  std::vector<std::filesystem::path> made_;  // the innermost first
  std::unique_ptr<Descriptor> lock_;
};

}  // namespace kelpie::file
