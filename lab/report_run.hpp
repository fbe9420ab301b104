// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "cli/interrupt.hpp"
#include "cli/progress.hpp"
#include "file/out_folder.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie::lab {

/// Runs a study with a progress bar. `study` takes a function to call with the finished share,
/// which returns false to stop. Throws Failure after an interrupt by the user.
template <typename Study>
auto run_watched(const char* name, Study study) {
  const cli::InterruptGuard guard;
  cli::ProgressBar progress(name);
  auto result = study([&progress](double share) {
    progress.at(share);
    return !cli::InterruptGuard::asked();
  });
  if (cli::InterruptGuard::asked()) {
    throw Failure("interrupted; nothing was written");
  }
  return result;
}

/// The results of a study.
struct StudyReport {
  std::string table;   ///< for the terminal
  std::string json{};  ///< for programs and lab/plot.py
  std::string html{};  ///< a page, or empty
};

/// Takes the folder for <name>.json and <name>.html. Throws the errors of take_out_folder().
file::OutFolder take_report_folder(const std::string& folder, const std::string& name,
                                   const std::vector<std::string>& inputs);

/// Writes the files, and prints the table and the paths.
void write_report(const file::OutFolder& folder, const std::string& name,
                  const StudyReport& report);

}  // namespace kelpie::lab
