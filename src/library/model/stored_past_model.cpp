// SPDX-License-Identifier: Apache-2.0
#include "kelpie/model/stored_past_model.hpp"

#include <algorithm>
#include <numeric>

#include "kelpie/core/scaling.hpp"
#include "kelpie/motion/term_set.hpp"
#include "kelpie/svr/online_svr.hpp"
#include "svr/past_model.hpp"
#include "svr/sample_collector.hpp"

namespace kelpie {
namespace {

// The samples in order of time, without those there is no room for.
std::vector<std::size_t> latest(const std::vector<double>& times_s, std::size_t most) {
  std::vector<std::size_t> order(times_s.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return times_s[i]; });
  order.erase(order.begin(),
              order.end() - static_cast<std::ptrdiff_t>(std::min(order.size(), most)));
  return order;
}

}  // namespace

StoredPastModel in_log_units(const PastModel& past, const AxisScaling& scaling) {
  StoredPastModel model{.info = past.info, .inputs = {}, .targets = {}, .times_s = {}};
  model.info.usual_error *= scaling.target.scale;
  std::vector<double> z(scaling.input.dimension());
  for (std::size_t i = 0; i < past.size(); ++i) {
    past.samples.get(i, z);
    const ScaledInput x = scaling.input.invert(z);
    model.inputs.insert(model.inputs.end(), x.begin(), x.end());
    model.targets.push_back(scaling.target.invert(past.targets[i]));
    model.times_s.push_back(past.times_s[i]);
  }
  return model;
}

PastModel in_learner_units(const StoredPastModel& model, const AxisScaling& scaling,
                           const TermSet& terms, const OnlineSvr& like) {
  const std::size_t inputs = scaling.input.dimension();
  PastModel past(like.buffer().kernel(), like.settings().places());
  past.info = model.info;
  past.info.usual_error /= scaling.target.scale;
  for (const std::size_t i : latest(model.times_s, like.settings().places() - 1)) {
    const std::size_t place = past.size();
    const std::span<const double> x = std::span(model.inputs).subspan(i * inputs, inputs);
    past.samples.push_back(as_span(scale_sample(scaling, terms, x)));
    past.targets[place] = scaling.target.apply(model.targets[i]);
    past.times_s[place] = model.times_s[i];
  }
  return past;
}

}  // namespace kelpie
