// SPDX-License-Identifier: Apache-2.0
#include "fleet/results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <regex>
#include <utility>

#include "fleet/tuning.hpp"
#include "fleet/worker.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/kelpie.h"

namespace kelpie::fleet {
namespace {

using file::Json;

constexpr const char* kKind = "kelpie-study-journal";
constexpr const char* kError = "error";  // key of a result that says why there is no outcome

std::string journal_name(const std::optional<Part>& part) {
  return part ? fmt::format("journal.part-{}-of-{}.jsonl", part->number, part->count)
              : kJournalName;
}

jobs::JournalHeader header_of(const Plan& plan) {
  return {{"kelpie", kelpie_version()}, {"study", plan.name}};
}

// Of a journal's file name; none where it isn't that of a part.
std::optional<Part> part_in(const std::string& name) {
  static const std::regex pattern(R"(journal\.part-(\d{1,7})-of-(\d{1,7})\.jsonl)");
  std::smatch match;
  return std::regex_match(name, match, pattern)
             ? std::optional(Part{std::stoul(match[1]), std::stoul(match[2])})
             : std::nullopt;
}

// What is wrong with a log, by the name that it has in the study, wherever its folder is.
std::string with_name(const std::string& error, const Mission& mission) {
  const std::string file = mission.file.string();
  return error.starts_with(file) ? mission.log + error.substr(file.size()) : error;
}

}  // namespace

std::string Part::text() const {
  return fmt::format("{}/{}", number, count);
}

Part Part::parse(const std::string& text) {
  static const std::regex pattern(R"((\d{1,7})/(\d{1,7}))");
  std::smatch match;
  if (std::regex_match(text, match, pattern)) {
    const Part part{std::stoul(match[1]), std::stoul(match[2])};
    if (part.number >= 1 && part.number <= part.count && part.count <= kTuning.most_parts) {
      return part;
    }
  }
  throw InputError("--part",
                   fmt::format("has to be k/n with 1 <= k <= n, such as 2/16; not '{}'", text));
}

Results::Results(const Plan& plan, const std::vector<Mission>& missions,
                 const std::filesystem::path& folder, Access access, std::optional<Part> part)
    : plan_(plan), missions_(missions), combinations_(plan, missions.size()) {
  const std::string own = journal_name(part);
  if (access == Access::run) {
    own_ = std::make_unique<jobs::Journal>(folder / own, kKind, header_of(plan));
  }
  open_others(folder, own);
  const std::vector<std::size_t> part_of =
      part ? jobs::deal_by_cost(all_jobs(), part->count) : std::vector<std::size_t>();
  for (std::size_t i = 0; i < combinations_.size(); ++i) {
    if (!part || part_of[i] == part->number - 1) {
      assigned_.push_back(i);
    }
  }
  look_up();
}

std::vector<jobs::Job> Results::all_jobs() const {
  std::vector<jobs::Job> jobs;
  for (std::size_t i = 0; i < combinations_.size(); ++i) {
    jobs.push_back(job_of(plan_, missions_, combinations_[i]));
  }
  return jobs;
}

void Results::open_others(const std::filesystem::path& folder, const std::string& own) {
  std::vector<std::filesystem::directory_entry> files;
  if (std::filesystem::is_directory(folder)) {
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      const std::string name = entry.path().filename().string();
      if (name.starts_with("journal.") && name.ends_with(".jsonl") && !(own_ && name == own)) {
        files.push_back(entry);
      }
    }
  }
  std::ranges::sort(files, std::greater{}, [](const auto& file) {
    return std::pair(file.last_write_time(), file.path().string());
  });
  for (const auto& file : files) {
    others_.push_back(std::make_unique<jobs::JournalReader>(file.path(), kKind, header_of(plan_)));
    if (const auto part = part_in(file.path().filename().string()); part && parts_ == 1) {
      parts_ = part->count;
    }
  }
}

// Where each combination has an outcome, or why it has none.
void Results::look_up() {
  found_.assign(combinations_.size(), nullptr);
  for (const std::size_t i : assigned_) {
    const std::string name = key(i);
    const auto look_in = [&](const jobs::JournalReader& journal) {
      if (found_[i] != nullptr || !journal.has(name)) {
        return;
      }
      const Json json = file::parse_json(journal.result(name), journal.file().string());
      if (!json.contains(kError)) {
        found_[i] = &journal;
      } else if (!own_) {
        failures_.try_emplace(
            i, with_name(json.at(kError).get<std::string>(), missions_[combinations_[i].mission]));
      }
    };
    if (own_) {
      look_in(*own_);
    }
    for (const auto& journal : others_) {
      look_in(*journal);
    }
    if (found_[i] != nullptr) {
      failures_.erase(i);
    }
  }
}

bool Results::run(jobs::Executor& executor, const std::function<bool(double)>& keep_going) {
  std::vector<std::size_t> missing;
  std::vector<jobs::Job> jobs;
  for (const std::size_t i : assigned_) {
    if (found_[i] == nullptr) {
      missing.push_back(i);
      jobs.push_back(job_of(plan_, missions_, combinations_[i]));
    }
  }
  Worker worker(plan_, missions_);
  return executor.run({.jobs = jobs,
                       .work =
                           [&](std::size_t i, const jobs::Advance& advance) {
                             return worker(combinations_[missing[i]], advance);
                           },
                       .done =
                           [&](std::size_t i, const std::string& result) {
                             own_->add(key(missing[i]), result);
                             enter(missing[i], result);
                           },
                       .keep_going = keep_going});
}

void Results::enter(std::size_t i, const std::string& result) {
  const Json json = file::parse_json(result, key(i));
  if (json.contains(kError)) {
    failures_[i] =
        with_name(json.at(kError).get<std::string>(), missions_[combinations_[i].mission]);
  } else {
    found_[i] = own_.get();
  }
}

std::size_t Results::done() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(assigned_, [this](std::size_t i) { return found_[i] != nullptr; }));
}

std::optional<Outcome> Results::outcome(std::size_t i) const {
  if (found_[i] == nullptr) {
    return std::nullopt;
  }
  const std::string source = found_[i]->file().string();
  const Json json = file::parse_json(found_[i]->result(key(i)), source);
  return read_outcome(file::JsonNode(json, source, "result"));
}

std::map<Part, std::size_t> Results::missing() const {
  const std::vector<std::size_t> part_of = jobs::deal_by_cost(all_jobs(), parts_);
  std::map<Part, std::size_t> parts;
  for (const std::size_t i : assigned_) {
    if (found_[i] == nullptr && !failures_.contains(i)) {
      ++parts[{part_of[i] + 1, parts_}];
    }
  }
  return parts;
}

}  // namespace kelpie::fleet
