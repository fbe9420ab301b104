// SPDX-License-Identifier: Apache-2.0
#include "log/draft_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "kelpie/core/scaling.hpp"
#include "kelpie/core/text.hpp"
#include "log/draft_names.hpp"

namespace kelpie::log {
namespace {

constexpr std::array<const char*, 6> kAxes{"u", "v", "w", "p", "q", "r"};
constexpr double kLeastMotion = 0.1;  // of the largest velocity's range, for heave to count

std::string signal_why(const CandidateColumn& column) {
  return fmt::format("{}{:.3g} Hz, {:.4g} to {:.4g}", column.unit.empty() ? "" : column.unit + ", ",
                     column.rate_hz, column.low, column.high);
}

std::string rate_of_change(const std::string& unit) {
  return unit.ends_with("/s") ? unit + "^2" : unit + "/s";
}

class Planner {
 public:
  Planner(const bag::BagReport& report, const std::string& time)
      : report_(report), all_(find_candidates(report)) {
    plan_.time = time;
    plan_.is_of_bag = !(report.topics.size() == 1 && report.topics.front().name.empty());
  }

  DraftPlan run() {
    const std::optional<Candidate> velocity = choose(Part::velocity, "velocities", "");
    const std::optional<Candidate> rates =
        choose(Part::rates, "rates", velocity ? topic_of(*velocity) : "");
    const std::optional<Candidate> commands = choose(Part::commands, "commands", "");
    if (velocity) {
      take_motion(*velocity, 0);
      turn_velocity(*velocity);
    }
    if (rates) {
      take_motion(*rates, velocity ? 3 : 0);
    }
    require_motion();
    if (commands) {
      take_commands(*commands);
    } else if (!is_asked(Part::commands)) {
      plan_.open.push_back(none_known(Part::commands, "commands"));
    }
    plan_times(report_, {used_, moving_rate_hz_, command_rate_hz_}, plan_);
    return std::move(plan_);
  }

 private:
  static std::string topic_of(const Candidate& one) {
    for (const CandidateColumn& column : one.columns) {
      if (column.exists()) {
        return column.topic;
      }
    }
    return "";
  }

  static bool varies(const Candidate& one) {
    return std::ranges::any_of(one.columns, &CandidateColumn::varies);
  }

  std::string none_known(Part part, const std::string& table) const {
    const std::string name = part == Part::commands ? "commands" : "velocities";
    const auto still = still_.find(part);
    return still != still_.end()
               ? fmt::format("{}: {} never changes, and there are no others", name, still->second)
               : fmt::format("no {} are known by type or name; name them in [log.{}]", name, table);
  }

  bool is_asked(Part part) const { return asked_.contains(part); }

  // The one of the least rank that moves at all; of `topic` before all others. Where two have that
  // rank both are written, as comments.
  std::optional<Candidate> choose(Part part, const std::string& name, const std::string& topic) {
    std::vector<const Candidate*> likely;
    std::vector<const Candidate*> others;
    for (const Candidate& one : all_) {
      if (one.part != part) {
        continue;
      }
      if (!varies(one)) {
        plan_.remarks.push_back(fmt::format("{}: constant, not taken for {}", one.what, name));
        still_.try_emplace(part, one.what);
      } else if (likely.empty() || one.rank == likely.front()->rank) {
        likely.push_back(&one);
      } else {
        others.push_back(&one);
      }
    }
    const auto own = std::ranges::find_if(
        likely, [&](const Candidate* one) { return !topic.empty() && topic_of(*one) == topic; });
    if (own != likely.end()) {
      likely = {*own};
    }
    if (likely.size() > 1) {
      asked_.insert(part);
      std::vector<std::string> names;
      for (const Candidate* const one : likely) {
        names.push_back(one->what);
        write_as_comment(*one, "one of several readings: ");
      }
      plan_.open.push_back(fmt::format("{}: {}: which of them?", name, join_text(names, ", or ")));
      return std::nullopt;
    }
    if (part == Part::commands) {
      for (const Candidate* const one : others) {
        write_as_comment(*one, "not taken: ");
      }
    }
    return likely.empty() ? std::nullopt : std::optional(*likely.front());
  }

  void write_as_comment(const Candidate& one, const std::string& why) {
    if (one.columns.size() > kMostInputs) {
      return;
    }
    DraftPlan::Group group{.head = why + one.what + ": " + one.why, .lines = {}, .is_taken = false};
    const std::vector<std::string> names = one.part == Part::commands
                                               ? short_names(one.columns)
                                               : names_of_axes(one.part == Part::velocity ? 0 : 3);
    for (std::size_t k = 0; k < one.columns.size(); ++k) {
      if (one.columns[k].varies()) {
        group.lines.push_back({names[k], one.columns[k].name, signal_why(one.columns[k])});
      }
    }
    (one.part == Part::commands ? plan_.commands : plan_.states).push_back(std::move(group));
  }

  static std::vector<std::string> names_of_axes(std::size_t first) {
    return {kAxes[first], kAxes[first + 1], kAxes[first + 2]};
  }

  void add_line(DraftPlan::Group& group, const std::string& name, const CandidateColumn& column) {
    group.lines.push_back({name, column.name, signal_why(column)});
    used_.push_back(column);
    if (!column.unit.empty()) {
      plan_.units.push_back({name, column.unit, {}});
    }
    plan_.taken.push_back(fmt::format("{} = {} ({})", name, column.name, signal_why(column)));
  }

  // Of velocities that are turned into the body's axes all three have to be there; ranges don't
  // tell then which of them move.
  void take_motion(const Candidate& one, std::size_t least) {
    const std::size_t first = one.part == Part::velocity ? 0 : 3;
    const bool is_of_world =
        one.part == Part::velocity && (one.frame == "NED" || one.frame == "ENU");
    DraftPlan::Group group{
        .head = one.what + ": " + (one.frame.empty() ? "" : one.frame + ": ") + one.why,
        .lines = {}};
    double widest = 0.0;
    for (const CandidateColumn& column : one.columns) {
      widest = std::max(widest, column.high - column.low);
    }
    for (std::size_t k = 0; k < one.columns.size(); ++k) {
      const CandidateColumn& column = one.columns[k];
      const std::string name = kAxes[first + k];
      if (!column.exists()) {
        continue;
      }
      add_line(group, name, column);
      const bool moves = column.varies() && (is_of_world || name != "w" ||
                                             column.high - column.low > kLeastMotion * widest);
      const bool is_steered = first == 0 || name == "r" || least == 0;
      if (moves && is_steered) {
        moving_.push_back(name);
        moving_rate_hz_ = std::min(moving_rate_hz_, column.rate_hz);
      }
    }
    plan_.states.insert(plan_.states.begin() + static_cast<std::ptrdiff_t>(taken_groups_++),
                        std::move(group));
  }

  void turn_velocity(const Candidate& velocity) {
    if (velocity.frame != "NED" && velocity.frame != "ENU") {
      return;
    }
    const std::string topic = topic_of(velocity);
    const Candidate* best = nullptr;
    for (const Candidate& one : all_) {
      const bool is_one = (one.part == Part::angles || one.part == Part::quaternion) &&
                          one.frame == velocity.frame && one.columns.front().exists();
      if (is_one && (best == nullptr || (topic_of(one) == topic && topic_of(*best) != topic))) {
        best = &one;
      }
    }
    if (best == nullptr) {
      plan_.open.push_back(
          fmt::format("velocities: {} is of the world ({}), and there is no attitude to turn it by",
                      velocity.what, velocity.frame));
      return;
    }
    const bool is_angles = best->part == Part::angles;
    const std::vector<std::string> names = is_angles
                                               ? std::vector<std::string>{"phi", "theta", "psi"}
                                               : std::vector<std::string>{"qw", "qx", "qy", "qz"};
    DraftPlan::Group group{.head = best->what + ": " + best->why, .lines = {}};
    bool is_in_degrees = false;
    for (std::size_t k = 0; k < names.size(); ++k) {
      const CandidateColumn& column = best->columns[k];
      add_line(group, names[k], column);
      is_in_degrees = is_in_degrees || column.unit.starts_with("deg") || column.high > 7.0;
    }
    plan_.states.insert(plan_.states.begin() + static_cast<std::ptrdiff_t>(taken_groups_++),
                        std::move(group));
    plan_.vectors.push_back(fmt::format(
        R"({{columns = ["u", "v", "w"], from = "{}", to = "{}", attitude = ["{}"]{}}})",
        velocity.frame, velocity.frame == "NED" ? "FRD" : "FLU", join_text(names, "\", \""),
        is_angles && is_in_degrees ? ", angles = \"deg\"" : ""));
  }

  void require_motion() {
    if (moving_.empty() && !is_asked(Part::velocity) && !is_asked(Part::rates)) {
      plan_.open.push_back(none_known(Part::velocity, "states"));
    }
    for (const std::string& name : moving_) {
      plan_.inputs.push_back(name);
      plan_.targets.push_back(name + "dot");
      plan_.derived.push_back({name + "dot", name, {}});
    }
    if (!moving_.empty() && !std::ranges::any_of(moving_, [](const auto& name) {
          return name == "u" || name == "v" || name == "w";
        })) {
      plan_.remarks.emplace_back("no velocities over ground: only turning can be learned");
    }
    for (const DraftPlan::Line& unit : std::vector(plan_.units)) {
      if (std::ranges::find(moving_, unit.name) != moving_.end()) {
        plan_.units.push_back({unit.name + "dot", rate_of_change(unit.from), {}});
      }
    }
  }

  void take_commands(const Candidate& one) {
    if (plan_.inputs.size() + one.columns.size() > kMostInputs) {
      plan_.open.push_back(
          fmt::format("commands: {}: {} are more than a model takes; which of them?", one.what,
                      one.columns.size()));
      return;
    }
    const std::vector<std::string> names = short_names(one.columns);
    DraftPlan::Group group{.head = one.what.size() > 200 ? one.why : one.what + ": " + one.why,
                           .lines = {}};
    std::vector<std::string> still;
    for (std::size_t k = 0; k < names.size(); ++k) {
      if (!one.columns[k].varies()) {
        still.push_back(one.columns[k].name);
        continue;
      }
      add_line(group, names[k], one.columns[k]);
      plan_.inputs.push_back(names[k]);
      command_rate_hz_ = std::min(command_rate_hz_, one.columns[k].rate_hz);
    }
    if (!still.empty()) {
      plan_.remarks.push_back("constant, not taken: " + join_text(still, ", "));
    }
    plan_.commands.insert(plan_.commands.begin(), std::move(group));
  }

  const bag::BagReport& report_;
  std::vector<Candidate> all_;
  DraftPlan plan_;
  std::map<Part, std::string> still_;  // what is constant
  std::set<Part> asked_;               // which of two isn't told
  std::vector<CandidateColumn> used_;  // states and commands that are taken
  std::vector<std::string> moving_;    // velocities that are learned
  std::size_t taken_groups_ = 0;       // of the states
  double moving_rate_hz_ = INFINITY;
  double command_rate_hz_ = INFINITY;
};

}  // namespace

DraftPlan plan_draft(const bag::BagReport& report, const std::string& time) {
  return Planner(report, time).run();
}

}  // namespace kelpie::log
