// SPDX-License-Identifier: Apache-2.0
#include "bag/mat_topics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "bag/reader.hpp"
#include "bag/stamp_unit.hpp"
#include "bag/tuning.hpp"
#include "core/text.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie::bag {
namespace {

std::string scope_of(const std::string& path) {
  const std::size_t dot = path.rfind('.');
  return dot == std::string::npos ? "" : path.substr(0, dot);
}

bool is_within(const std::string& path, const std::string& scope) {
  return scope.empty() || path.starts_with(scope + ".");
}

std::size_t vector_length(const MatArray& array) {
  return array.rows == 1 || array.columns == 1 ? std::max(array.rows, array.columns) : 0;
}

// How good a name it is for times, 0 the best; none: no name for them.
std::optional<std::size_t> rank_of(const std::string& path) {
  constexpr std::array<std::string_view, 11> kNames{"t",      "time",      "tout",       "stamp",
                                                    "stamps", "timestamp", "timestamps", "times",
                                                    "tt",     "seconds",   "sec"};
  const std::string name = without_time_unit(path.substr(path.rfind('.') + 1));
  if (const auto* const found = std::ranges::find(kNames, name); found != kNames.end()) {
    return static_cast<std::size_t>(found - kNames.begin());
  }
  const bool is_one = name.starts_with("t_") || name.starts_with("time_") ||
                      name.ends_with("_time") || name.ends_with("_stamp") ||
                      name.ends_with("_timestamp");
  return is_one ? std::optional(kNames.size()) : std::nullopt;
}

bool never_falls(const std::vector<double>& values) {
  return std::ranges::is_sorted(values) && values.front() < values.back();
}

// Days tell themselves by their steps; of all else the name says more than the size.
StampUnit unit_of(const MatArray& array) {
  const auto by_size =
      unit_by_size(array.values.front(), array.values.back(), array.values.size() - 1);
  const auto by_name = unit_in_name(array.path);
  return by_size && (by_size->zero != 0.0 || !by_name) ? *by_size
                                                       : by_name.value_or(StampUnit{"s"});
}

// Puts the topics of a file together.
class TopicFinder {
 public:
  TopicFinder(const std::vector<MatArray>& arrays, const RowTimes& times)
      : arrays_(arrays), wish_(times) {}

  std::vector<MatTopic> find() {
    find_times();
    std::vector<Group> rest;
    for (const MatArray& array : arrays_) {
      const bool is_time =
          std::ranges::any_of(clocks_, [&](const Clock& clock) { return clock.times == &array; });
      if (is_time || array.values.size() < 2) {
        continue;
      }
      if (Clock* const clock = clock_of(array)) {
        clock->columns.push_back({&array, array.rows != clock->times->values.size()});
      } else {
        add_to_group(rest, array);
      }
    }
    make_timed_topics();
    make_counted_topics(std::move(rest));
    return std::move(topics_);
  }

 private:
  struct Clock {
    const MatArray* times;
    std::string scope;
    std::size_t rank = 0;
    std::vector<MatTopic::Column> columns{};
  };

  // Arrays without a time: beside each other, and of one length.
  struct Group {
    std::string scope;
    std::size_t rows = 0;
    std::vector<MatTopic::Column> columns{};
  };

  static void add_to_group(std::vector<Group>& groups, const MatArray& array) {
    const bool is_across = array.columns > array.rows;
    const std::size_t rows = is_across ? array.columns : array.rows;
    const std::string scope = scope_of(array.path);
    auto group = std::ranges::find_if(
        groups, [&](const Group& there) { return there.scope == scope && there.rows == rows; });
    if (group == groups.end()) {
      groups.push_back({.scope = scope, .rows = rows});
      group = groups.end() - 1;
    }
    group->columns.push_back({&array, is_across});
  }

  void find_times() {
    for (const MatArray& array : arrays_) {
      const bool is_wished = !wish_.time.empty() &&
                             (array.path == wish_.time || array.path.ends_with("." + wish_.time));
      const std::optional<std::size_t> rank =
          is_wished ? std::optional<std::size_t>(0) : rank_of(array.path);
      const bool may_be = rank && vector_length(array) >= 2 &&
                          (is_wished || (wish_.time.empty() && never_falls(array.values)));
      if (may_be) {
        add_clock({.times = &array, .scope = scope_of(array.path), .rank = *rank});
      }
    }
    if (!wish_.time.empty() && clocks_.empty()) {
      std::vector<std::string> paths;
      std::ranges::transform(arrays_, std::back_inserter(paths), &MatArray::path);
      throw InputError(wish_.time, "there is no vector of this name to take the time from" +
                                       did_you_mean(wish_.time, paths));
    }
  }

  // Of two of one length beside each other, the better name has it.
  void add_clock(const Clock& clock) {
    const auto same = std::ranges::find_if(clocks_, [&](const Clock& there) {
      return there.scope == clock.scope && there.times->values.size() == clock.times->values.size();
    });
    if (same == clocks_.end()) {
      clocks_.push_back(clock);
    } else if (clock.rank < same->rank) {
      *same = clock;
    }
  }

  // The nearest around it.
  Clock* clock_of(const MatArray& array) {
    Clock* found = nullptr;
    for (Clock& clock : clocks_) {
      const std::size_t length = clock.times->values.size();
      const bool fits =
          (array.rows == length || array.columns == length) && is_within(array.path, clock.scope);
      if (fits && (found == nullptr || clock.scope.size() > found->scope.size())) {
        found = &clock;
      }
    }
    return found;
  }

  void make_timed_topics() {
    double first_s = 0.0;
    for (const Clock& clock : clocks_) {
      const StampUnit unit = unit_of(*clock.times);
      for (const double value : clock.times->values) {
        first_s = std::min(first_s, std::isfinite(value) ? unit.seconds_of(value) : 0.0);
      }
    }
    for (Clock& clock : clocks_) {
      const bool is_alone = std::ranges::count(clocks_, clock.scope, &Clock::scope) == 1;
      if (clock.columns.empty()) {
        continue;
      }
      MatTopic& topic = add_topic(is_alone ? clock.scope : clock.times->path, clock.scope,
                                  std::move(clock.columns));
      topic.has_time = true;
      const StampUnit unit = unit_of(*clock.times);
      for (const double value : clock.times->values) {
        const double time_ns = (unit.seconds_of(value) - first_s) * 1e9;
        const bool is_time = time_ns >= 0.0 && time_ns <= static_cast<double>(Message::kLatestNs);
        topic.times_ns.push_back(is_time ? std::llround(time_ns) : MatTopic::kNoTime);
      }
    }
  }

  // The largest of a struct goes by its name.
  void make_counted_topics(std::vector<Group> groups) {
    std::ranges::stable_sort(groups, std::ranges::greater(),
                             [](const Group& one) { return one.rows * one.columns.size(); });
    const double step_ns = wish_.rate_hz > 0.0 ? 1e9 / wish_.rate_hz : 1e9;
    for (Group& group : groups) {
      MatTopic& topic = add_topic(group.scope, group.scope, std::move(group.columns));
      for (std::size_t k = 0; k < group.rows; ++k) {
        topic.times_ns.push_back(std::llround(static_cast<double>(k) * step_ns));
      }
    }
  }

  MatTopic& add_topic(const std::string& wanted, const std::string& scope,
                      const std::vector<MatTopic::Column>& columns) {
    const std::string name = wanted.empty() ? "workspace" : wanted;
    std::string unique = name;
    for (int k = 2; !names_.insert(unique).second; ++k) {
      unique = fmt::format("{}_{}", name, k);
    }
    MatTopic& topic = topics_.emplace_back();
    topic.name = unique;
    std::set<std::string> fields;
    for (const MatTopic::Column& column : columns) {
      std::string field = column.array->path.substr(scope.empty() ? 0 : scope.size() + 1);
      std::ranges::replace(field, '.', '_');
      if (fields.insert(field).second) {
        topic.columns.push_back(column);
        topic.definition += column.width() == 1
                                ? fmt::format("float64 {}\n", field)
                                : fmt::format("float64[{}] {}\n", column.width(), field);
      }
    }
    return topic;
  }

  const std::vector<MatArray>& arrays_;
  const RowTimes& wish_;
  std::vector<Clock> clocks_;
  std::set<std::string> names_;
  std::vector<MatTopic> topics_;
};

}  // namespace

std::vector<MatTopic> mat_topics(const std::vector<MatArray>& arrays, const RowTimes& times) {
  return TopicFinder(arrays, times).find();
}

}  // namespace kelpie::bag
