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
  const std::string page = name + ".html";
  const std::string numbers = name + ".json";
  std::string written = "numbers: " + (folder.path() / numbers).string() + "\n";
  if (report.html.empty()) {
    file::write_files_whole(folder.path(), {{numbers, report.json}});
    written += "picture: lab/plot.py " + (folder.path() / numbers).string() + "\n";
  } else {
    file::write_files_whole(folder.path(), {{page, report.html}, {numbers, report.json}});
    written.insert(0, "page:    " + (folder.path() / page).string() + "\n");
  }
  cli::say("{}{}", report.table, written);
}

}  // namespace kelpie::lab
