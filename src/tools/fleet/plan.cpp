// SPDX-License-Identifier: Apache-2.0
#include "fleet/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <set>
#include <string_view>
#include <utility>

#include "core/text.hpp"
#include "file/json.hpp"
#include "fleet/tuning.hpp"
#include "kelpie/core/error.hpp"
#include "study/alignment.hpp"
#include "study/split.hpp"

namespace kelpie::fleet {
namespace {

using file::TomlNode;

constexpr std::array<std::string_view, 5> kTakenNames{"least squares", "mean", "last value", "best",
                                                      ""};

const std::vector<std::string> kSourceKeys{"logs", "config", "log", "align", "recover"};

std::vector<std::string> with(std::vector<std::string> keys, const std::vector<std::string>& more) {
  keys.insert(keys.end(), more.begin(), more.end());
  return keys;
}

// Runs `check`; what it finds wrong stands at `node`.
template <typename Check>
auto at_node(const TomlNode& node, Check check) {
  try {
    return check();
  } catch (const InputError& error) {
    node.refuse(error.message());
  }
}

std::vector<std::string> one_or_more(const TomlNode& node, const std::string& kind) {
  return node.type() == file::TomlNode::Type::text
             ? std::vector{node.text()}
             : file::texts_of(node, kind + ", or a list of them");
}

// Whether there is a setting of this name that takes such a value: for one target, or for as many
// as it has values.
void check_setting(const std::string& name, const std::string& value) {
  if (name == "preset") {
    ModelSettings::from_preset(value, 1);
    return;
  }
  ModelSettings settings = ModelSettings::from_preset("default", split_text(value, ',').size());
  settings.assign(name, value);
  settings.validate();
}

LearnerConfig read_learner(const TomlNode& node) {
  LearnerConfig learner{node["name"].text(), {}};
  if (std::ranges::count(kTakenNames, trimmed(learner.name)) > 0 ||
      learner.name.find('|') != std::string::npos) {
    node["name"].refuse("'" + learner.name +
                        "' can't be a learner's name: it is empty, has a | "
                        "in it, or is what others are called");
  }
  const auto assign = [&](const TomlNode& value) {
    at_node(value, [&] { check_setting(value.key(), value.setting()); });
    learner.set.push_back(value.key() + "=" + value.setting());
  };
  if (node.has("preset")) {
    assign(node["preset"]);
  }
  if (node.has("set")) {
    for (const TomlNode& setting : node["set"].members("a table of settings")) {
      if (setting.key() == "preset") {
        setting.refuse("stands beside `set`, as in preset = \"small\"");
      }
      assign(setting);
    }
  }
  return learner;
}

std::vector<LearnerConfig> read_learners(const TomlNode& root) {
  if (!root.has("learner")) {
    return {{"kelpie", {}}};
  }
  std::vector<LearnerConfig> learners;
  for (const TomlNode& node : root["learner"].tables({"name", "preset", "set"})) {
    learners.push_back(read_learner(node));
    if (std::ranges::count(learners, learners.back().name, &LearnerConfig::name) > 1) {
      node["name"].refuse("'" + learners.back().name + "' is the name of two learners");
    }
  }
  return learners;
}

std::vector<SplitOptions> read_splits(const TomlNode& root) {
  std::uint64_t seeds = 1;
  if (root.has("seeds")) {
    seeds = root["seeds"].count();
    if (seeds == 0 || seeds > kTuning.most_seeds) {
      root["seeds"].refuse(fmt::format(
          "has to be 1 to {}: so many random splits, with the seeds 1, 2, …", kTuning.most_seeds));
    }
  }
  if (!root.has("splits")) {
    return {{"auto", 1}};
  }
  const TomlNode node = root["splits"];
  std::vector<SplitOptions> splits;
  for (const std::string& text : one_or_more(node, "a split, as in \"pieces\"")) {
    const study::SplitKind kind = at_node(node, [&] { return study::parse_split(text, 1).kind; });
    if (kind == study::SplitKind::none) {
      node.refuse("'none' holds out no rows to judge learners by");
    }
    if (std::ranges::count(splits, text, &SplitOptions::split) > 0) {
      node.refuse("has '" + text + "' twice");
    }
    for (std::uint64_t seed = 1; seed <= (kind == study::SplitKind::random ? seeds : 1); ++seed) {
      splits.push_back({text, seed});
    }
  }
  if (splits.empty()) {
    node.refuse("names no split");
  }
  return splits;
}

void read_config(const TomlNode& node, const std::filesystem::path& folder, Source& source) {
  file::Json identity = {{"align", source.align}, {"recover", source.recover}};
  if (node.has("config")) {
    if (node.has("log")) {
      node["config"].refuse("may not stand beside `log`; the file has a table [log] of its own");
    }
    const TomlNode config = TomlNode::read(folder / node["config"].text("a TOML file"));
    source.log = log::read_log_config(config);
    source.settings = format::read_settings_file(config);
    for (const auto& setting : source.settings.settings) {
      at_node(config[setting.first], [&] { check_setting(setting.first, setting.second.text); });
    }
    identity["config"] = config.canonical();
  } else if (node.has("log")) {
    source.log = log::read_log_config(node);
    identity["log"] = node["log"].canonical();
  }
  source.identity = identity.dump();
}

Source read_source(const TomlNode& node, const std::filesystem::path& folder) {
  Source source;
  source.line = node["logs"].place().line;
  if (node.has("name")) {
    source.vehicle = node["name"].text();
  }
  for (const std::string& text : one_or_more(node["logs"], "a path with or without wildcards")) {
    source.logs.push_back(at_node(node["logs"], [&] { return LogPattern(text); }));
  }
  if (source.logs.empty()) {
    node["logs"].refuse("names no log");
  }
  if (node.has("align")) {
    source.align = node["align"].setting();
    at_node(node["align"], [&] { study::check_align(source.align, "align"); });
  }
  source.recover = node.has("recover") && node["recover"].flag();
  read_config(node, folder, source);
  return source;
}

}  // namespace

Plan read_plan(const std::filesystem::path& file) {
  const TomlNode root = TomlNode::read(file);
  root.table(with({"name", "splits", "seeds", "learner", "vehicle"}, kSourceKeys));
  Plan plan;
  plan.file = file;
  plan.name = root.has("name") ? root["name"].text() : file.stem().string();
  plan.learners = read_learners(root);
  plan.splits = read_splits(root);
  if (!root.has("vehicle")) {
    // What is said at the top is of all logs. Its name is the study's.
    plan.sources.push_back(read_source(root, plan.folder()));
    plan.sources.back().vehicle.clear();
    return plan;
  }
  for (const std::string& key : kSourceKeys) {
    if (root.has(key)) {
      root[key].refuse("may not stand beside [[vehicle]]; it belongs into each of these tables");
    }
  }
  for (const TomlNode& node : root["vehicle"].tables(with({"name"}, kSourceKeys))) {
    plan.sources.push_back(read_source(node, plan.folder()));
  }
  return plan;
}

std::filesystem::path Plan::folder() const {
  return std::filesystem::absolute(file).lexically_normal().parent_path();
}

}  // namespace kelpie::fleet
