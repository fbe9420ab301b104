// SPDX-License-Identifier: Apache-2.0
#include "cli/sampling_config.hpp"

#include <algorithm>
#include <array>

#include "kelpie/core/text.hpp"

namespace kelpie::cli {
namespace {

// The word's place among `words`.
template <std::size_t Count>
std::size_t choice(const file::TomlNode& value, const std::array<std::string, Count>& words) {
  const std::string text = value.text("one of " + join_text(words, ", "));
  const auto found = std::ranges::find(words, text);
  if (found == words.end()) {
    value.refuse("'" + text + "' is none of " + join_text(words, ", ") + did_you_mean(text, words));
  }
  return static_cast<std::size_t>(found - words.begin());
}

std::array<std::string, 3> three_names(const file::TomlNode& value) {
  const std::vector<std::string> names = value.texts("a list of three columns, x, y and z");
  if (names.size() != 3) {
    value.refuse("has to be a list of three columns, x, y and z");
  }
  return {names[0], names[1], names[2]};
}

class SamplingReader {
 public:
  explicit SamplingReader(const file::TomlNode& log) : log_(log) {}

  SamplingConfig read() {
    with("states", [&](const file::TomlNode& value) { read_sources(value, log::Between::line); });
    with("commands", [&](const file::TomlNode& value) { read_sources(value, log::Between::hold); });
    with("derived", [&](const file::TomlNode& value) { read_derived(value); });
    with("lag", [&](const file::TomlNode& value) { read_lags(value); });
    with("lag_part", [&](const file::TomlNode& value) { read_lag_part(value); });
    with("vectors", [&](const file::TomlNode& value) { read_vectors(value); });
    with("lever_arm", [&](const file::TomlNode& value) { read_lever_arm(value); });
    with("gap", [&](const file::TomlNode& value) { plan().gap_s = value.number("a number of s"); });
    with("clock", [&](const file::TomlNode& value) {
      config_.clock = choice(value, std::array<std::string, 2>{"receive", "header"}) == 0
                          ? bag::Clock::receive
                          : bag::Clock::header;
    });
    with("messages", [&](const file::TomlNode& value) {
      config_.messages = std::filesystem::path(value.file).parent_path() / value.text("a folder");
    });
    read_filter();
    return std::move(config_);
  }

 private:
  log::SamplingPlan& plan() { return config_.plan; }

  template <typename Use>
  void with(const std::string& key, Use use) {
    if (const toml::node* const node = log_.node.as_table()->get(key)) {
      use(log_.child(key, *node));
    }
  }

  void read_sources(const file::TomlNode& value, log::Between between) {
    for (const auto& [name, node] : value.table("a table of columns and where they come from")) {
      const file::TomlNode source = value.child(std::string(name.str()), node);
      plan().sources.push_back(
          {.name = std::string(name.str()),
           .from = source.text("a topic and field, as in \"/odom:twist.twist.linear.x\""),
           .between = between});
    }
  }

  // udot = "d(u)"
  void read_derived(const file::TomlNode& value) {
    for (const auto& [name, node] : value.table("a table, as in {udot = \"d(u)\"}")) {
      const file::TomlNode derived = value.child(std::string(name.str()), node);
      const std::string kind = "the derivative of a column, as in \"d(u)\"";
      const std::string text = derived.text(kind);
      if (!text.starts_with("d(") || !text.ends_with(')')) {
        derived.refuse("'" + text + "' has to be " + kind);
      }
      const std::string of(trimmed(std::string_view(text).substr(2, text.size() - 3)));
      require_source(derived, of);
      plan().derived.push_back({std::string(name.str()), of});
    }
  }

  log::SamplingPlan::Source& require_source(const file::TomlNode& user, const std::string& name) {
    const auto found = std::ranges::find(plan().sources, name, &log::SamplingPlan::Source::name);
    if (found == plan().sources.end()) {
      std::vector<std::string> names;
      std::ranges::transform(plan().sources, std::back_inserter(names),
                             &log::SamplingPlan::Source::name);
      user.refuse("'" + name + "' is no state or command" + did_you_mean(name, names) + ": " +
                  join_text(names, ", "));
    }
    return *found;
  }

  static std::optional<double> lag_of(const file::TomlNode& value) {
    const std::string kind = "\"auto\" or a number of s";
    if (!value.node.is_string()) {
      return value.number(kind);
    }
    if (value.text() != "auto") {
      value.refuse("has to be " + kind);
    }
    return std::nullopt;
  }

  void read_lags(const file::TomlNode& value) {
    if (const auto* const table = value.node.as_table()) {
      for (const auto& [name, node] : *table) {
        const file::TomlNode lag = value.child(std::string(name.str()), node);
        require_source(lag, std::string(name.str())).lag_s = lag_of(lag);
      }
      return;
    }
    for (log::SamplingPlan::Source& source : plan().sources) {
      if (source.between == log::Between::hold) {
        source.lag_s = lag_of(value);
      }
    }
  }

  void read_lag_part(const file::TomlNode& value) {
    plan().lag_part = value.number();
    if (!(plan().lag_part > 0.0 && plan().lag_part <= 1.0)) {
      value.refuse("is out of range; it has to be more than 0, up to 1");
    }
  }

  static Frame frame_of(const file::TomlNode& value) {
    try {
      return frame_from(value.text("a frame: FLU, FRD, ENU or NED"));
    } catch (const InputError& error) {
      if (!error.place().file.empty()) {
        throw;
      }
      value.refuse(error.what());
    }
  }

  // The value of `name` in a table that has to have it.
  static file::TomlNode member(const file::TomlNode& value, const std::string& name,
                               const std::string& kind) {
    const toml::node* const node = value.table(kind).get(name);
    if (node == nullptr) {
      value.refuse("lacks " + name + "; it has to be " + kind);
    }
    return value.child(name, *node);
  }

  void read_vectors(const file::TomlNode& value) {
    const std::string kind =
        "a list of tables, as in [{columns = [\"u\", \"v\", \"w\"], from = \"FLU\", to = \"FRD\"}]";
    const auto* const list = value.node.as_array();
    if (list == nullptr) {
      value.refuse("has to be " + kind);
    }
    for (const toml::node& item : *list) {
      const file::TomlNode vector{value.file, value.key, item};
      plan().vectors.push_back({.columns = three_names(member(vector, "columns", kind)),
                                .from = frame_of(member(vector, "from", kind)),
                                .to = frame_of(member(vector, "to", kind))});
    }
  }

  void read_lever_arm(const file::TomlNode& value) {
    const std::string kind =
        "a table, as in {velocity = [\"u\", \"v\", \"w\"], rates = [\"p\", \"q\", \"r\"], arm = "
        "[0.3, 0.0, -0.1]}";
    log::SamplingPlan::LeverArm lever{.velocity = three_names(member(value, "velocity", kind)),
                                      .rates = three_names(member(value, "rates", kind))};
    const file::TomlNode arm = member(value, "arm", kind);
    const auto* const list = arm.node.as_array();
    if (list == nullptr || list->size() != lever.arm_m.size()) {
      arm.refuse("has to be a list of three numbers of m");
    }
    for (std::size_t c = 0; c < lever.arm_m.size(); ++c) {
      lever.arm_m[c] = file::TomlNode{arm.file, arm.key, (*list)[c]}.number("three numbers of m");
    }
    plan().lever_arm = lever;
  }

  void read_filter() {
    with("filter", [&](const file::TomlNode& value) {
      plan().derivative.window = choice(value, std::array<std::string, 2>{"centred", "causal"}) == 0
                                     ? log::FilterWindow::centred
                                     : log::FilterWindow::causal;
    });
    with("window",
         [&](const file::TomlNode& value) { plan().derivative.window_s = value.number(); });
    with("degree", [&](const file::TomlNode& value) {
      if (!value.node.is_integer()) {
        value.refuse("has to be a whole number");
      }
      plan().derivative.degree = static_cast<int>(value.number());
    });
  }

  file::TomlNode log_;
  SamplingConfig config_;
};

}  // namespace

std::span<const std::string> sampling_keys() {
  static const std::array<std::string, 13> keys{
      "states", "commands", "derived", "clock",   "messages",  "gap",     "filter",
      "window", "degree",   "lag",     "vectors", "lever_arm", "lag_part"};
  return keys;
}

SamplingConfig read_sampling(const file::TomlNode& log) {
  return SamplingReader(log).read();
}

}  // namespace kelpie::cli
