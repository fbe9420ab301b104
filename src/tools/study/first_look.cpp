// SPDX-License-Identifier: Apache-2.0
#include "study/first_look.hpp"

#include <memory>
#include <vector>

#include "study/alignment.hpp"
#include "study/baselines.hpp"
#include "study/metrics.hpp"
#include "study/split.hpp"

namespace kelpie::study {
namespace {

std::vector<double> r2_of(const log::Dataset& data, const Split& split) {
  const std::size_t targets = data.target_names.size();
  std::vector<double> r2(targets, FirstLook::Axis{}.r2);
  const std::unique_ptr<OnlineModel> model =
      data.input_names.empty() ? nullptr : make_least_squares(data);
  if (!model) {
    return r2;
  }
  for (const std::size_t row : split.training) {
    model->update(data.input(row), data.target(row), data.times_s[row]);
  }
  for (std::size_t axis = 0; axis < targets; ++axis) {
    std::vector<double> truth;
    std::vector<double> said;
    for (const std::size_t row : split.held_out) {
      truth.push_back(data.target(row)[axis]);
      said.push_back(model->axis(axis).predict(data.input(row)));
    }
    r2[axis] = r_squared(truth, said);
  }
  return r2;
}

}  // namespace

FirstLook first_look(const log::Dataset& data) {
  const Split split = make_split(data, {.kind = SplitKind::pieces});
  FirstLook look{.rows = data.rows(),
                 .held_out = split.held_out.size(),
                 .rate_hz = data.rate_hz,
                 .alignment = choose_alignment(data, split, "auto", "auto"),
                 .axes = {}};
  const std::vector<double> with = r2_of(aligned(data, look.alignment.alignment), split);
  const std::vector<double> alone =
      r2_of(without_inputs(data, look.alignment.alignment.commands), split);
  for (std::size_t axis = 0; axis < data.target_names.size(); ++axis) {
    look.axes.push_back({data.target_names[axis], with[axis], alone[axis]});
  }
  return look;
}

}  // namespace kelpie::study
