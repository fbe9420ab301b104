// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/command.hpp"
#include "support.hpp"

namespace kelpie::testing {

/// Learns a few hundred rows in no time.
inline constexpr const char* kLittleStudy = R"(
logs = "dives/{vehicle}/{mission}.csv"
splits = "pieces"

[[learner]]
name = "small"
preset = "small"
set = {warmup = 20, buffer = 30}

[[learner]]
name = "no terms"
preset = "small"
set = {warmup = 20, buffer = 30, terms = "none"}
)";

inline void write_dive(const std::filesystem::path& folder, const std::string& name,
                       std::size_t rows) {
  const std::filesystem::path file = folder / ("dives/" + name + ".csv");
  std::filesystem::create_directories(file.parent_path());
  write_text(file, little_log(rows));
}

/// fleet.toml with four logs of `rows` rows or a few more: 8 runs.
inline void write_little_study(const std::filesystem::path& folder, std::size_t rows = 300) {
  for (const char* const log : {"auv1/dive1", "auv1/dive2", "auv1/dive10", "auv2/dive1"}) {
    write_dive(folder, log, rows++);
  }
  write_text(folder / "fleet.toml", kLittleStudy);
}

inline nlohmann::json study_result(const std::filesystem::path& folder) {
  return nlohmann::json::parse(content_of(folder / "study.json"));
}

/// study.json as it was written, but for the times, which no two runs have alike.
inline std::string without_times(const std::filesystem::path& folder) {
  auto study = nlohmann::ordered_json::parse(content_of(folder / "study.json"));
  for (auto& run : study["runs"]) {
    run.erase("seconds");
    run.erase("times");
  }
  for (auto& vehicle : study["vehicles"]) {
    vehicle.erase("times");
  }
  for (auto& learner : study["overall"]) {
    learner.erase("times");
  }
  return study.dump(1);
}

}  // namespace kelpie::testing
