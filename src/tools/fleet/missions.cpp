// SPDX-License-Identifier: Apache-2.0
#include "fleet/missions.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <system_error>

#include "core/seconds.hpp"
#include "core/text.hpp"
#include "file/crc32.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie::fleet {
namespace {

namespace fs = std::filesystem;

// Adds the file's size, and its time where that is the latest.
void take_stamp(const fs::path& file, Mission& mission) {
  struct stat status = {};
  if (::stat(file.c_str(), &status) == 0 && S_ISREG(status.st_mode)) {
    mission.bytes += static_cast<std::uintmax_t>(status.st_size);
    mission.changed_ns = std::max<std::int64_t>(
        mission.changed_ns, status.st_mtim.tv_sec * kSecondNs + status.st_mtim.tv_nsec);
  }
}

// Of a file, or of all files of a folder. What can't be looked at shows when the log is read.
void stamp(Mission& mission) {
  std::error_code error;
  if (!fs::is_directory(mission.file, error)) {
    take_stamp(mission.file, mission);
    return;
  }
  for (fs::directory_iterator at(mission.file, error); !error && at != fs::directory_iterator();
       at.increment(error)) {
    take_stamp(at->path(), mission);
  }
}

// Why this can be no log; "" otherwise.
std::string no_log(const fs::path& file, bool recover) {
  std::error_code error;
  if (fs::is_directory(file, error)) {
    return recover || fs::exists(file / "metadata.yaml", error)
               ? ""
               : "a folder without metadata.yaml, so no bag";
  }
  return fs::is_regular_file(file, error) ? "" : "no file";
}

Mission mission_of(const MatchedLog& log, const Plan& plan, std::size_t source) {
  const fs::path file = log.file.lexically_normal();
  Mission mission{.file = file,
                  .log = file.lexically_relative(plan.folder()).string(),
                  .vehicle = plan.sources[source].vehicle,
                  .mission = log.mission,
                  .source = source};
  if (mission.vehicle.empty()) {
    mission.vehicle = log.vehicle.empty() ? file.parent_path().filename().string() : log.vehicle;
  }
  if (mission.mission.empty()) {
    mission.mission = mission.log;
  }
  return mission;
}

// Numbers count as numbers; names that differ by leading zeros alone by their letters.
bool before(const Mission& a, const Mission& b) {
  const int vehicles = ::strverscmp(a.vehicle.c_str(), b.vehicle.c_str());
  return vehicles != 0 ? vehicles < 0 : ::strverscmp(a.log.c_str(), b.log.c_str()) < 0;
}

}  // namespace

std::vector<Mission> find_missions(const Plan& plan) {
  std::map<fs::path, Mission> found;
  for (std::size_t source = 0; source < plan.sources.size(); ++source) {
    const auto refuse = [&](const std::string& why) {
      throw InputError(
          {.file = plan.file.string(), .line = plan.sources[source].line, .field = "logs"}, why);
    };
    for (const LogPattern& pattern : plan.sources[source].logs) {
      const std::vector<MatchedLog> logs = pattern.find(plan.folder());
      if (logs.empty()) {
        refuse(fmt::format("'{}' matches no file in {}", pattern.text(), plan.folder().string()));
      }
      for (const MatchedLog& log : logs) {
        if (const std::string why = no_log(log.file, plan.sources[source].recover); !why.empty()) {
          refuse(
              fmt::format("'{}' matches {}, which is {}", pattern.text(), log.file.string(), why));
        }
        Mission mission = mission_of(log, plan, source);
        const auto [place, is_new] = found.try_emplace(mission.file, mission);
        if (!is_new && place->second.vehicle != mission.vehicle) {
          refuse(fmt::format("{} would be a log of {} and of {}", mission.log,
                             place->second.vehicle, mission.vehicle));
        }
      }
    }
  }
  std::vector<Mission> missions;
  for (auto& [file, mission] : found) {
    stamp(mission);
    missions.push_back(std::move(mission));
  }
  std::ranges::sort(missions, before);
  return missions;
}

std::string key_of(const Plan& plan, std::span<const Mission> missions, const Combination& one) {
  const Mission& mission = missions[one.mission];
  const SplitOptions& split = plan.splits[one.split];
  const LearnerConfig& learner = plan.learners[one.learner];
  const std::string depends =
      fmt::format("{}\n{}\n{}\n{}\n{}", mission.log, mission.bytes, mission.changed_ns,
                  plan.sources[mission.source].identity, join_text(learner.set, "\n"));
  return fmt::format("{} | {} | {} | {} | {:08x}", mission.log, split.split, split.seed,
                     learner.name, file::crc32_of(std::as_bytes(std::span(depends))));
}

}  // namespace kelpie::fleet
