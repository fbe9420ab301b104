// SPDX-License-Identifier: Apache-2.0
#include "lab/control_report.hpp"

#include <fmt/format.h>

#include <vector>

#include "chart/text_table.hpp"
#include "file/json.hpp"

namespace kelpie::lab {
namespace {

std::string case_title(const ControlCase& one) {
  return path_name(one.path) + ", " + mishap_name(one.mishap);
}

std::string millimetres(double metres) {
  return fmt::format("{:.1f}", 1e3 * metres);
}

chart::TextTable errors_table(const ControlResult& result) {
  chart::TextTable table{
      fmt::format("Distance to where the vehicle should be, root mean square in mm, mean of {} "
                  "seeds (simulation): before / during / after",
                  result.seeds),
      {"mission"},
      {}};
  for (const ControllerKind kind : kControllers) {
    table.head.push_back(controller_name(kind));
  }
  table.head.emplace_back("worst (c)/(a)");
  for (const ControlCase& one : result.cases) {
    std::vector<std::string>& row = table.rows.emplace_back(1, case_title(one));
    for (const ControllerKind kind : kControllers) {
      row.push_back(millimetres(mean_error(one, kind, &MissionErrors::before)) + " / " +
                    millimetres(mean_error(one, kind, &MissionErrors::during)) + " / " +
                    millimetres(mean_error(one, kind, &MissionErrors::after)));
    }
    row.push_back(fmt::format("{:.2f}", worst_against_pid(one)));
  }
  table.whole = true;
  return table;
}

file::Json case_json(const ControlCase& one) {
  file::Json controllers = file::Json::array();
  for (std::size_t i = 0; i < kControllers.size(); ++i) {
    std::vector<double> before;
    std::vector<double> during;
    std::vector<double> after;
    std::vector<double> fallback;
    for (const MissionErrors& errors : one.flown[i]) {
      before.push_back(errors.before);
      during.push_back(errors.during);
      after.push_back(errors.after);
      fallback.push_back(errors.fallback_share);
    }
    controllers.push_back({{"name", controller_name(kControllers[i])},
                           {"before_m", file::numbers(before)},
                           {"during_m", file::numbers(during)},
                           {"after_m", file::numbers(after)},
                           {"fallback_share", file::numbers(fallback)},
                           {"time_s", file::numbers(one.flown[i].front().time_s)},
                           {"error_m", file::numbers(one.flown[i].front().error_m)}});
  }
  return {{"path", path_name(one.path)},
          {"mishap", mishap_name(one.mishap)},
          {"worst_c_over_a", file::number(worst_against_pid(one))},
          {"controllers", std::move(controllers)}};
}

}  // namespace

std::string control_table(const ControlResult& result) {
  return chart::table_text(errors_table(result));
}

std::string control_json(const ControlResult& result) {
  const MissionTimes& times = result.times;
  const file::Json document = {{"format", "kelpie-control"},
                               {"version", 1},
                               {"simulated", true},
                               {"seeds", result.seeds},
                               {"first_seed", result.first_seed},
                               {"settle_s", times.settle_s},
                               {"before_s", times.before_s},
                               {"during_s", times.during_s},
                               {"after_s", times.after_s},
                               {"cases", file::list(result.cases, case_json)}};
  return file::json_text(document, 1);
}

}  // namespace kelpie::lab
