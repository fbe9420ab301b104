// SPDX-License-Identifier: Apache-2.0
#include "log/sampling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

#include "kelpie/core/error.hpp"
#include "log/pose_instants.hpp"
#include "log/streamed_signals.hpp"

namespace kelpie::log {
namespace {

// The plan of a stream that keeps all there is, and gives every column.
StreamPlan plan_for(const SamplingPlan& plan, const std::vector<Signal>& signals) {
  StreamPlan whole = plan;
  whole.targets.clear();
  for (std::size_t k = 0; k < signals.size(); ++k) {
    StreamPlan::Source& source = whole.sources[k];
    source.keep = std::max<std::size_t>(signals[k].values.size(), 1);
    source.lag_s = source.lag_s.value_or(0.0);
  }
  whole.inputs = sampled_columns(plan);
  return whole;
}

// Makes the table, step by step.
class Sampler {
 public:
  Sampler(const SamplingPlan& plan, std::vector<Signal> signals)
      : plan_(plan), signals_(std::move(signals)), stream_plan_(plan_for(plan, signals_)) {}

  Samples run() {
    std::ranges::for_each(signals_, sort_by_time);
    std::ranges::for_each(signals_, [&](const Signal& signal) { require_one_clock(signal); });
    require_whole_vectors();
    std::optional<PoseWindowChoice> window = choose_window();
    std::optional<TopicAlignment> lags;
    double lag_until_s = 0.0;
    if (!std::ranges::all_of(plan_.sources, [](const auto& s) { return s.lag_s.has_value(); })) {
      StreamedSignals unshifted(stream_plan_, signals_);
      const TopicAlignmentProblem problem = lag_problem(unshifted);
      lags = align_topics(problem);
      lag_until_s = problem.times_s.back();
      set_lags(*lags);
    }
    StreamedSignals streamed(stream_plan_, signals_);
    Samples samples;
    samples.report.pose_half_s = stream_plan_.pose ? stream_plan_.pose->half_s : 0.0;
    samples.report.window = std::move(window);
    samples.report.lags = std::move(lags);
    samples.report.lag_until_s = lag_until_s;
    report_on(streamed, samples.report);
    samples.table = table_of(streamed);
    count_rows(samples.table, samples.report);
    if (plan_.with_instants) {
      samples.instants = pose_instants(stream_plan_, std::move(signals_));
    }
    return samples;
  }

 private:
  void require_one_clock(const Signal& signal) const {
    if (signal.longest_back_s > plan_.gap_s) {
      throw InputError(signal.from,
                       fmt::format("time goes back by {:.3f} s; clocks set during the log are not "
                                   "followed",
                                   signal.longest_back_s));
    }
  }

  // Components that come in different messages are hardly one vector.
  void require_whole_vectors() const {
    const auto require_whole = [&](const std::array<std::string, 3>& names) {
      const Signal& first = signals_[plan_.source(names[0])];
      for (const std::string& name : names) {
        const Signal& part = signals_[plan_.source(name)];
        if (part.times_s != first.times_s) {
          throw InputError(part.from, "doesn't come in the same messages as " + first.from +
                                          "; the three components of a vector have to");
        }
      }
    };
    std::ranges::for_each(plan_.vectors, require_whole, &StreamPlan::Vector::columns);
    if (plan_.lever_arm) {
      require_whole(plan_.lever_arm->velocity);
    }
  }

  // Of a pose without a window.
  std::optional<PoseWindowChoice> choose_window() {
    if (!stream_plan_.pose || stream_plan_.pose->half_s > 0.0) {
      return std::nullopt;
    }
    double first_s = std::numeric_limits<double>::infinity();
    double last_s = -first_s;
    for (const Signal& signal : signals_) {
      if (!signal.times_s.empty()) {
        first_s = std::min(first_s, signal.times_s.front());
        last_s = std::max(last_s, signal.times_s.back());
      }
    }
    PoseWindowChoice choice =
        find_pose_window(stream_plan_, signals_, first_s + plan_.lag_part * (last_s - first_s));
    stream_plan_.pose->half_s = choice.half_s;
    return choice;
  }

  bool is_response(const std::string& name) const {
    return std::ranges::find(plan_.responses, name) != plan_.responses.end();
  }

  bool is_pose_velocity(const std::string& name) const {
    return plan_.pose && std::ranges::count(StreamPlan::Pose::kVelocities, name) > 0;
  }

  TopicAlignmentProblem lag_problem(StreamedSignals& streamed) const {
    TopicAlignmentProblem problem;
    const auto share = plan_.lag_part * static_cast<double>(streamed.times_s.size());
    const std::size_t rows = std::min(static_cast<std::size_t>(share), plan_.lag_rows);
    const auto first_of = [&](const std::vector<double>& column) {
      return std::vector<double>(column.begin(),
                                 column.begin() + static_cast<std::ptrdiff_t>(rows));
    };
    problem.times_s = first_of(streamed.times_s);
    problem.step_s = 0.5 / plan_.rate_hz;
    for (std::size_t column = 0; column < streamed.columns.size(); ++column) {
      const std::string& name = stream_plan_.inputs[column];
      const auto found = std::ranges::find(plan_.sources, name, &StreamPlan::Source::name);
      const auto source = static_cast<std::size_t>(found - plan_.sources.begin());
      const bool is_source = found != plan_.sources.end();
      if (is_source && !found->lag_s) {
        add_to_group(problem, source, streamed.signal(source));
      } else if (is_response(name)) {
        problem.responses.push_back(first_of(streamed.columns[column]));
      } else if ((is_source && found->between != Interpolation::hold) || is_pose_velocity(name)) {
        problem.background.push_back(first_of(streamed.columns[column]));
      }
    }
    if (problem.responses.empty()) {
      throw InputError("lag",
                       "to be estimated it takes targets to go by; none is a state or derived");
    }
    return problem;
  }

  void add_to_group(TopicAlignmentProblem& problem, std::size_t source,
                    const SignalHistory& signal) const {
    const std::string& topic = signals_[source].topic;
    auto group = std::ranges::find(problem.groups, topic, &TopicAlignmentProblem::Group::topic);
    if (group == problem.groups.end()) {
      group = problem.groups.insert(
          group, {.topic = topic, .signals = {}, .between = plan_.sources[source].between});
    }
    group->signals.push_back(&signal);
  }

  const TopicLag& found_for(const TopicAlignment& lags, std::size_t source) const {
    return *std::ranges::find(lags.topics, signals_[source].topic, &TopicLag::topic);
  }

  void set_lags(const TopicAlignment& lags) {
    for (std::size_t k = 0; k < signals_.size(); ++k) {
      if (!plan_.sources[k].lag_s) {
        stream_plan_.sources[k].lag_s = found_for(lags, k).lag_s;
      }
    }
  }

  void report_on(const StreamedSignals& streamed, SamplingReport& report) const {
    for (std::size_t k = 0; k < signals_.size(); ++k) {
      const double step = median_step_s(signals_[k]);
      const double lag_s = stream_plan_.sources[k].lag_s.value_or(0.0);
      report.sources.push_back({.name = plan_.sources[k].name,
                                .from = plan_.sources[k].from,
                                .rate_hz = step > 0.0 ? 1.0 / step : 0.0,
                                .faults = streamed.signal(k).faults(),
                                .lag_s = lag_s,
                                .lag_origin = lag_s != 0.0 ? "given" : ""});
      report.sources.back().faults.steps_back = signals_[k].steps_back;
      if (report.lags && !plan_.sources[k].lag_s) {
        report.sources.back().lag_origin =
            found_for(*report.lags, k).is_own ? "estimated" : "estimated, common";
      }
    }
    for (const StreamPlan::Derived& derived : plan_.derived) {
      const double step = median_step_s(signals_[plan_.source(derived.of)]);
      if (step <= 0.0) {
        throw InputError(derived.of, "has one sample; a derivative takes several");
      }
      report.derived.push_back(
          {.name = derived.name, .info = derivative_info(step, plan_.derivative)});
    }
  }

  Table table_of(StreamedSignals& streamed) const {
    Table table;
    table.lines.resize(streamed.times_s.size());
    std::iota(table.lines.begin(), table.lines.end(), std::size_t{1});
    table.names = stream_plan_.inputs;
    table.names.insert(table.names.begin(), "t");
    table.columns = std::move(streamed.columns);
    table.columns.insert(table.columns.begin(), streamed.times_s);
    return table;
  }

  void count_rows(const Table& table, SamplingReport& report) const {
    const std::vector<double>& times_s = table.columns.front();
    report.rate_hz = plan_.rate_hz;
    report.rows = table.rows();
    bool was_whole = false;
    for (std::size_t row = 0; row < table.rows(); ++row) {
      was_whole = was_whole && times_s[row] - times_s[row - 1] < 1.5 / plan_.rate_hz;
      const bool is_whole = std::ranges::all_of(
          table.columns, [&](const auto& column) { return std::isfinite(column[row]); });
      report.whole_rows += is_whole ? 1 : 0;
      report.segments += is_whole && !was_whole ? 1 : 0;
      was_whole = is_whole;
    }
  }

  const SamplingPlan& plan_;
  std::vector<Signal> signals_;
  StreamPlan stream_plan_;  // with lags, once they are estimated
};

}  // namespace

std::vector<std::string> sampled_columns(const StreamPlan& plan) {
  std::vector<std::string> names;
  const auto is_of_pose = [&](const std::string& name) {
    return plan.pose &&
           (std::ranges::count(plan.pose->position, name) > 0 ||
            (plan.pose->attitude.size() == 4 && std::ranges::count(plan.pose->attitude, name) > 0));
  };
  for (const StreamPlan::Source& source : plan.sources) {
    if (!is_of_pose(source.name)) {
      names.push_back(source.name);
    }
  }
  std::ranges::transform(plan.derived, std::back_inserter(names), &StreamPlan::Derived::name);
  const std::vector<std::string> of_pose =
      plan.pose ? plan.pose->columns() : std::vector<std::string>{};
  names.insert(names.end(), of_pose.begin(), of_pose.end());
  return names;
}

Samples sample(const SamplingPlan& plan, std::vector<Signal> signals, const std::string& source) {
  return in_file(source, [&] {
    plan.validate();
    Samples samples = Sampler(plan, std::move(signals)).run();
    samples.table.source = source;
    return samples;
  });
}

}  // namespace kelpie::log
