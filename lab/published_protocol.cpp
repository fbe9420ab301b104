// SPDX-License-Identifier: Apache-2.0
#include "lab/published_protocol.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <numeric>
#include <string>
#include <utility>

#include "core/quantile.hpp"
#include "kelpie/core/error.hpp"
#include "log/dataset.hpp"
#include "log/read_log.hpp"
#include "study/result.hpp"
#include "study/split.hpp"
#include "study/stream.hpp"
#include "study/training_scales.hpp"

namespace kelpie::lab {
namespace {

constexpr std::size_t kTestEvery = 5;
constexpr std::size_t kValidationEvery = 4;
constexpr std::size_t kLate = 1000;

void summarise(PublishedRun& run) {
  const auto mean_and_least = [&](std::size_t from, double& mean, double& least) {
    mean = least = std::numeric_limits<double>::quiet_NaN();
    if (from < run.r2.size()) {
      const auto first = run.r2.begin() + static_cast<std::ptrdiff_t>(from);
      mean = std::accumulate(first, run.r2.end(), 0.0) / static_cast<double>(run.r2.size() - from);
      least = *std::min_element(first, run.r2.end());
    }
  };
  const auto late = std::ranges::lower_bound(run.steps, kLate) - run.steps.begin();
  mean_and_least(0, run.mean, run.minimum);
  mean_and_least(static_cast<std::size_t>(late), run.mean_late, run.minimum_late);
  run.end = run.r2.empty() ? std::numeric_limits<double>::quiet_NaN() : run.r2.back();
}

// The column `split` of the file tells who trains (0) and who is held out (1).
study::Split split_of(const log::Table& table, const log::Dataset& data) {
  const std::size_t column = table.find("split");
  table.require_numbers(column);
  if (data.rows() != table.rows()) {
    throw InputError({.file = table.source, .line = 0, .field = {}},
                     "has rows with a NaN or infinity; there have to be none");
  }
  study::Split split{"as in the column 'split'", {}, {}};
  for (std::size_t row = 0; row < table.rows(); ++row) {
    (table.columns[column][row] == 0.0 ? split.training : split.held_out).push_back(row);
  }
  return split;
}

// How many training rows there are before the switch.
std::size_t first_part(const log::Table& table, const log::Dataset& data,
                       const study::Split& split) {
  const auto second = std::ranges::find_if(
      split.training, [&](std::size_t row) { return data.configurations[row] != 0; });
  if (second == split.training.begin() || second == split.training.end() ||
      split.held_out.empty()) {
    throw InputError({.file = table.source, .line = 0, .field = "conf"},
                     "has to begin with configuration 0 and go on with 1, with rows held out");
  }
  return static_cast<std::size_t>(second - split.training.begin());
}

double r2_at(const study::AxisResult& axis, std::size_t samples) {
  const auto found = std::ranges::find(axis.validation, samples, &study::ValidationPoint::samples);
  return found == axis.validation.end() ? std::numeric_limits<double>::quiet_NaN() : found->r2;
}

}  // namespace

PublishedRows published_rows(std::size_t rows) {
  PublishedRows result;
  std::size_t left = 0;
  for (std::size_t i = 0; i + 1 < rows; ++i) {
    if (i % kTestEvery == 1) {
      result.test.push_back(i + 1);
    } else {
      (left % kValidationEvery == 1 ? result.validation : result.stream).push_back(i + 1);
      ++left;
    }
  }
  result.stream.pop_back();
  return result;
}

std::vector<Contender> published_contenders(std::size_t axes) {
  using Values = std::initializer_list<std::pair<const char*, const char*>>;
  ModelSettings base = ModelSettings::from_preset("default", axes);
  base.assign("buffer", std::to_string(kPublishedBuffer));
  // The protocol compares what learners make of a hundred samples; the posterior remembers more.
  const auto settings = [&base](Values first, Values then = {}) {
    ModelSettings model = base;
    model.assign("learner", "svr");
    model.assign("warmup", std::to_string(kPublishedBuffer));
    for (const Values& values : {first, then}) {
      for (const auto& [name, value] : values) {
        model.assign(name, value);
      }
    }
    return model;
  };
  const Values plain{{"terms", "none"}, {"fine", "0"}, {"lambda", "0"}};
  const ModelSettings ours = settings(plain, {{"gamma", "0.00838"},
                                              {"c", "91.6"},
                                              {"epsilon", "0.213"},
                                              {"xi", "0.8"},
                                              {"anchors", "60"},
                                              {"k", "1000"}});
  const ModelSettings fifo = settings(plain, {{"gamma", "0.0795"},
                                              {"c", "19.7"},
                                              {"epsilon", "0.513"},
                                              {"xi", "0.8"},
                                              {"anchors", "10"},
                                              {"outlier", "none"},
                                              {"forget", "fifo"}});
  const ModelSettings physics = settings({{"terms", "fossen"},
                                          {"gamma", "0.0325"},
                                          {"fine", "0.1"},
                                          {"lambda", "0.679"},
                                          {"c", "4.82"},
                                          {"epsilon", "0.32"},
                                          {"xi", "0.9"},
                                          {"anchors", "10"},
                                          {"k", "100"}});
  const auto with_fifo = [](ModelSettings model, const char* outlier) {
    model.assign("forget", "fifo");
    model.assign("adapt", "none");
    model.assign("outlier", outlier);
    return model;
  };
  return {online_svr_contender("plain", "kelpie, plain kernel", ours),
          online_svr_contender("plain_fifo_same", "FIFO, plain kernel, the same settings",
                               with_fifo(ours, "robust")),
          online_svr_contender("plain_fifo", "FIFO, plain kernel, its own best settings", fifo),
          online_svr_contender("proposed", "kelpie, physics terms", physics),
          online_svr_contender("fifo_same", "FIFO, physics terms, the same settings",
                               with_fifo(physics, "robust")),
          online_svr_contender("fifo", "FIFO, physics terms, its own best settings",
                               with_fifo(physics, "none")),
          model_contender("default", "kelpie, default preset", base)};
}

PublishedRun run_published(const log::Dataset& data, const std::vector<std::size_t>& stream,
                           const std::vector<std::size_t>& judged, const Contender& contender,
                           std::size_t every, const std::function<bool(std::size_t)>& keep_going) {
  const std::unique_ptr<OnlineModel> model = contender.make(data, {});
  const study::Split split{"as published", stream, judged};
  const study::StreamResult result =
      study::run_stream(data, split, *model, {.validate_every = every, .keep_going = keep_going});

  PublishedRun run{.name = contender.name, .settings = contender.settings};
  const auto axes = static_cast<double>(result.axes.size());
  for (std::size_t look = 0; look < result.axes.front().validation.size(); ++look) {
    const std::size_t samples = result.axes.front().validation[look].samples;
    if (samples > kPublishedBuffer) {
      double sum = 0.0;
      for (const study::AxisResult& axis : result.axes) {
        sum += axis.validation[look].r2;
      }
      run.steps.push_back(samples - kPublishedBuffer);
      run.r2.push_back(sum / axes);
    }
  }
  summarise(run);
  return run;
}

PeerRun run_peer(const std::filesystem::path& file, const Contender& contender,
                 const std::function<bool(std::size_t)>& keep_going) {
  const log::Log log = log::read_log({.path = file.string()}, {},
                                     {.inputs = {"u", "v", "r", "n1", "n2", "n3"},
                                      .targets = {"du"},
                                      .rate_hz = 1.0,
                                      .configuration = "conf"});
  const log::Dataset data = log.dataset();
  const study::Split split = split_of(log.table, data);
  const std::size_t first = first_part(log.table, data, split);
  const std::unique_ptr<OnlineModel> model = contender.make(
      data, study::training_scales(data, std::span(split.training).first(first), contender.shared));
  const std::array marks{std::size_t{1000}, first,        first + 500,
                         first + 1000,      first + 2000, split.training.size()};
  const study::StreamResult result = study::run_stream(data, split, *model,
                                                       {.validate_every = split.training.size(),
                                                        .also_at = {marks.begin(), marks.end()},
                                                        .keep_going = keep_going});
  const study::AxisResult& axis = result.axes.front();
  PeerRun run{.stream = file.stem().string(), .learner = contender.name};
  std::ranges::transform(marks, run.r2.begin(),
                         [&](std::size_t samples) { return r2_at(axis, samples); });
  std::vector<double> times = axis.update_us;
  run.median_us = quantile(times, 0.5);
  run.p99_us = quantile(times, 0.99);
  return run;
}

}  // namespace kelpie::lab
