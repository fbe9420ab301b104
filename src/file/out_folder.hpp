// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "file/descriptor.hpp"

namespace kelpie::file {

/// The folder that a run writes its results into, taken before the work begins: what would keep the
/// results from being written shows there and then, and no other run writes into it meanwhile.
/// The lock is a file `.kelpie.lock`, which is gone in the end; one that a killed process has left
/// locks nothing. (Where the file system knows no locks, other runs aren't seen.)
class OutFolder {
 public:
  /// Makes the folder where it is missing and removes drafts that killed processes have left of
  /// `names`, the files to be written. Throws InputError where another run has it, Failure where
  /// the folder can't be made or one of the files not be written.
  OutFolder(std::filesystem::path folder, const std::vector<std::string>& names);
  /// Removes the folder again if it was made here and is empty.
  ~OutFolder();
  OutFolder(const OutFolder&) = delete;
  OutFolder(OutFolder&&) = delete;
  OutFolder& operator=(const OutFolder&) = delete;
  OutFolder& operator=(OutFolder&&) = delete;

  const std::filesystem::path& path() const { return folder_; }

 private:
  explicit OutFolder(std::filesystem::path folder);
  void take();

  std::filesystem::path folder_;
  std::vector<std::filesystem::path> made_;  // the innermost first
  std::unique_ptr<Descriptor> lock_;
};

}  // namespace kelpie::file
