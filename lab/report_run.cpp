// SPDX-License-Identifier: Apache-2.0
#include "lab/report_run.hpp"

#include "cli/output.hpp"
#include "file/atomic_file.hpp"

namespace kelpie::lab {

file::OutFolder take_report_folder(const std::string& folder, const std::string& name,
                                   const std::vector<std::string>& inputs) {
  return cli::take_out_folder(folder, {name + ".html", name + ".json"}, inputs);
}

void write_report(const file::OutFolder& folder, const std::string& name,
                  const StudyReport& report) {
  file::write_files_whole(folder.path(),
                          {{name + ".html", report.html}, {name + ".json", report.json}});
  cli::say("{}page:    {}\nnumbers: {}\n", report.table,
           (folder.path() / (name + ".html")).string(),
           (folder.path() / (name + ".json")).string());
}

}  // namespace kelpie::lab
