// SPDX-License-Identifier: Apache-2.0
#include "log/sampling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

#include "kelpie/core/error.hpp"
#include "log/body_frame.hpp"

namespace kelpie::log {
namespace {

constexpr double kRounding = 1e-6;  // of a row
constexpr std::size_t kMostRowsPerSample = 1000;

[[noreturn]] void refuse(const std::string& name, const std::string& message) {
  throw InputError(name, message);
}

// Makes the table, step by step.
class Sampler {
 public:
  Sampler(const SamplingPlan& plan, std::vector<Signal> signals)
      : plan_(plan), signals_(std::move(signals)) {}

  Samples run() {
    to_body_frame(plan_, signals_);
    for (std::size_t k = 0; k < signals_.size(); ++k) {
      report_source(plan_.sources[k], tidy(signals_[k], plan_.gap_s), signals_[k]);
      require_line(k);
    }
    shift_given();
    make_grid();
    shift_estimated();
    make_grid();
    Samples samples;
    fill(samples.table);
    count_rows(samples.table);
    samples.report = std::move(report_);
    return samples;
  }

 private:
  void report_source(const SamplingPlan::Source& source, const SignalFaults& faults,
                     const Signal& signal) {
    const double step = median_step_s(signal);
    report_.sources.push_back({.name = source.name,
                               .from = source.from,
                               .rate_hz = step > 0.0 ? 1.0 / step : 0.0,
                               .faults = faults,
                               .lag_s = source.lag_s.value_or(0.0),
                               .lag_origin = source.lag_s.value_or(0.0) != 0.0 ? "given" : ""});
  }

  // A line through samples that are all too far apart has a value nowhere.
  void require_line(std::size_t source) const {
    const SignalFaults& faults = report_.sources[source].faults;
    if (plan_.sources[source].between == Between::line && faults.samples > 1 &&
        faults.gaps == faults.samples - 1) {
      refuse(
          signals_[source].from,
          fmt::format("its samples come every {:.4g} s, and silences longer than {:.4g} s aren't "
                      "bridged (`gap`); are its stamps in seconds?",
                      median_step_s(signals_[source]), plan_.gap_s));
    }
  }

  static void shift(Signal& signal, double lag_s) {
    std::ranges::for_each(signal.times_s, [&](double& t) { t -= lag_s; });
  }

  void shift_given() {
    for (std::size_t k = 0; k < signals_.size(); ++k) {
      shift(signals_[k], report_.sources[k].lag_s);
    }
  }

  // As far as every signal reaches.
  void make_grid() {
    const auto begins = [](const Signal& signal) { return signal.times_s.front(); };
    const auto ends = [](const Signal& signal) { return signal.times_s.back(); };
    const Signal& last_to_begin = *std::ranges::max_element(signals_, {}, begins);
    const Signal& first_to_end = *std::ranges::min_element(signals_, {}, ends);
    const double begin = begins(last_to_begin);
    const double end = ends(first_to_end);
    const double first = std::ceil(begin * plan_.rate_hz - kRounding);
    const double last = std::floor(end * plan_.rate_hz + kRounding);
    if (last < first) {
      refuse(first_to_end.from,
             fmt::format("ends at {:.3f} s, before {} begins at {:.3f} s (both since the log's "
                         "first message): no row has both; do their clocks agree?",
                         end, last_to_begin.from, begin));
    }
    fill_grid(first, last);
  }

  // The rows `first` to `last` but those in silences of all signals, which would have no value.
  void fill_grid(double first, double last) {
    std::vector<double> heard;  // when there was a sample
    for (const Signal& signal : signals_) {
      heard.insert(heard.end(), signal.times_s.begin(), signal.times_s.end());
    }
    std::ranges::sort(heard);
    grid_.clear();
    double row = first;
    for (const double time : heard) {
      row = std::max(row, std::ceil((time - plan_.gap_s) * plan_.rate_hz));
      const double end = std::min(last, (time + plan_.gap_s) * plan_.rate_hz);
      while (row <= end) {
        grid_.push_back(row / plan_.rate_hz);
        row += 1.0;
        if (grid_.size() > kMostRowsPerSample * heard.size()) {
          refuse("rate",
                 fmt::format("{:.4g} rows per second are more than {} per sample of the log",
                             plan_.rate_hz, kMostRowsPerSample));
        }
      }
    }
  }

  std::vector<double> column_of(std::size_t source, const std::vector<double>& at) const {
    return resampled(signals_[source], at, plan_.sources[source].between, plan_.gap_s);
  }

  std::vector<double> derived_of(const SamplingPlan::Derived& derived,
                                 const std::vector<double>& at) const {
    return derivative(signals_[index_of(derived.of)], at, plan_.derivative, plan_.gap_s);
  }

  std::size_t index_of(const std::string& name) const {
    return static_cast<std::size_t>(
        std::ranges::find(plan_.sources, name, &SamplingPlan::Source::name) -
        plan_.sources.begin());
  }

  bool is_asked_for(std::size_t source) const { return !plan_.sources[source].lag_s; }
  bool is_response(const std::string& name) const {
    return std::ranges::find(plan_.responses, name) != plan_.responses.end();
  }

  LagProblem lag_problem() const {
    LagProblem problem;
    const auto part = static_cast<std::size_t>(plan_.lag_part * static_cast<double>(grid_.size()));
    problem.times_s.assign(
        grid_.begin(), grid_.begin() + static_cast<std::ptrdiff_t>(std::min(part, plan_.lag_rows)));
    problem.gap_s = plan_.gap_s;
    problem.step_s = 0.5 / plan_.rate_hz;
    for (std::size_t k = 0; k < signals_.size(); ++k) {
      const SamplingPlan::Source& source = plan_.sources[k];
      if (is_asked_for(k)) {
        auto group =
            std::ranges::find(problem.groups, signals_[k].topic, &LagProblem::Group::topic);
        if (group == problem.groups.end()) {
          group = problem.groups.insert(
              group, {.topic = signals_[k].topic, .signals = {}, .between = source.between});
        }
        group->signals.push_back(&signals_[k]);
      } else if (is_response(source.name)) {
        problem.responses.push_back(column_of(k, problem.times_s));
      } else if (source.between == Between::line) {
        problem.background.push_back(column_of(k, problem.times_s));
      }
    }
    for (const SamplingPlan::Derived& derived : plan_.derived) {
      if (is_response(derived.name)) {
        problem.responses.push_back(derived_of(derived, problem.times_s));
      }
    }
    return problem;
  }

  void shift_estimated() {
    if (std::ranges::all_of(plan_.sources, [](const auto& s) { return s.lag_s.has_value(); })) {
      return;
    }
    const LagProblem problem = lag_problem();
    if (problem.responses.empty()) {
      refuse("lag", "to be estimated it takes targets to go by; none is a state or derived");
    }
    LagResult result = estimate_lags(problem);
    for (std::size_t k = 0; k < signals_.size(); ++k) {
      if (is_asked_for(k)) {
        const LagEstimate& found =
            *std::ranges::find(result.topics, signals_[k].topic, &LagEstimate::topic);
        report_.sources[k].lag_s = found.lag_s;
        report_.sources[k].lag_origin = found.is_own ? "estimated" : "estimated, common";
        shift(signals_[k], found.lag_s);
      }
    }
    report_.lag_until_s = problem.times_s.back();
    report_.lags = std::move(result);
  }

  void fill(Table& table) {
    table.lines.resize(grid_.size());
    std::iota(table.lines.begin(), table.lines.end(), std::size_t{1});
    table.names = {"t"};
    table.columns = {grid_};
    for (std::size_t k = 0; k < signals_.size(); ++k) {
      table.names.push_back(plan_.sources[k].name);
      table.columns.push_back(column_of(k, grid_));
    }
    for (const SamplingPlan::Derived& derived : plan_.derived) {
      table.names.push_back(derived.name);
      const double step = median_step_s(signals_[index_of(derived.of)]);
      if (step <= 0.0) {
        refuse(derived.of, "has one sample; a derivative takes several");
      }
      report_.derived.push_back(
          {.name = derived.name, .info = derivative_info(step, plan_.derivative)});
      table.columns.push_back(derived_of(derived, grid_));
    }
  }

  void count_rows(const Table& table) {
    report_.rows = table.rows();
    bool was_whole = false;
    for (std::size_t row = 0; row < table.rows(); ++row) {
      was_whole = was_whole && grid_[row] - grid_[row - 1] < 1.5 / plan_.rate_hz;
      const bool is_whole = std::ranges::all_of(
          table.columns, [&](const auto& column) { return std::isfinite(column[row]); });
      report_.whole_rows += is_whole ? 1 : 0;
      report_.segments += is_whole && !was_whole ? 1 : 0;
      was_whole = is_whole;
    }
  }

  const SamplingPlan& plan_;
  std::vector<Signal> signals_;
  SamplingReport report_;
  std::vector<double> grid_;
};

}  // namespace

Samples sample(const SamplingPlan& plan, std::vector<Signal> signals, const std::string& source) {
  try {
    plan.validate();
    Samples samples = Sampler(plan, std::move(signals)).run();
    samples.table.source = source;
    return samples;
  } catch (const InputError& error) {
    throw InputError({.file = source, .line = 0, .field = {}}, error.what());
  }
}

}  // namespace kelpie::log
