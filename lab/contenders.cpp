// SPDX-License-Identifier: Apache-2.0
#include "lab/contenders.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "core/text.hpp"
#include "kelpie/core/setting.hpp"
#include "kelpie/learner/recursive_least_squares.hpp"
#include "kelpie/model/dynamics_model.hpp"
#include "kelpie/motion/term_set.hpp"
#include "lab/sparse_online_svr.hpp"
#include "model/axis_list.hpp"
#include "model/first_scale.hpp"
#include "model/model_axis.hpp"

namespace kelpie::lab {
namespace {

// SOSVR wants scaled samples, and stays in the scale that it began with.
class ScaledSosvr final : public OnlineRegressor {
 public:
  ScaledSosvr(std::size_t inputs, const SparseOnlineSvrSettings& settings,
              std::optional<AxisScaling> scaling)
      : scale_(inputs, SharedSettings{}, {}, std::move(scaling)), learner_(inputs, settings) {}

  Decision update(std::span<const double> x, double y, double t) override {
    return scale_.update(learner_, x, y, t);
  }
  void learn_held_back() override { scale_.learn_held_back(learner_); }
  double predict(std::span<const double> x) const override { return scale_.predict(learner_, x); }
  Status status() const override { return scale_.status(learner_); }

 private:
  FirstScale scale_;
  SparseOnlineSvr learner_;
};

// A regressor for every target of a log, made by make(axis, scaling).
template <typename Make>
std::unique_ptr<OnlineModel> axis_list(const log::Dataset& data,
                                       std::span<const AxisScaling> scales, const Make& make) {
  std::vector<std::unique_ptr<OnlineRegressor>> axes;
  for (std::size_t axis = 0; axis < data.target_names.size(); ++axis) {
    axes.push_back(make(axis, scales.empty() ? std::nullopt : std::optional(scales[axis])));
  }
  return std::make_unique<AxisList>(std::move(axes));
}

std::unique_ptr<OnlineRegressor> online_svr(const log::Dataset& data, std::size_t axis,
                                            const ModelSettings& settings,
                                            std::optional<AxisScaling> scaling) {
  const TermSet terms =
      TermSet::from(settings.shared.terms, data.input_names, settings.axes.size());
  return make_axis(data.input_names.size(), settings.shared, settings.axes.at(axis), terms, {},
                   std::move(scaling));
}

SparseOnlineSvrSettings sosvr_settings(int dictionary, const NamedValues& values) {
  SparseOnlineSvrSettings settings;
  settings.dictionary = dictionary;
  for (const auto& [name, value] : values) {
    std::ranges::find(sparse_online_svr_fields(), name, &Setting<SparseOnlineSvrSettings>::name)
        ->assign(settings, value);
  }
  return settings;
}

template <typename Settings>
std::string text_of(std::span<const Setting<Settings>> fields, const Settings& settings) {
  std::string text;
  for (const Setting<Settings>& field : fields) {
    text += fmt::format("{}{}={}", text.empty() ? "" : " ", field.name, field.get(settings));
  }
  return text;
}

std::string text_of(const ModelSettings& settings) {
  settings.validate();
  std::string text;
  for (const auto& [name, value] : settings.values()) {
    text += fmt::format("{}{}={}", text.empty() ? "" : " ", name, value);
  }
  return text;
}

constexpr int kBuffer = 900;  // of Table I

ModelSettings with(ModelSettings settings, const NamedValues& values) {
  for (const auto& [name, value] : values) {
    settings.assign(name, value);
  }
  return settings;
}

// The rules of the paper with the values found, over the values of Table I.
ModelSettings paper_settings(const AxisValues& found, std::size_t axes) {
  ModelSettings settings = ModelSettings::from_preset("paper", axes);
  for (std::size_t i = 0; !found.empty() && i < found.front().size(); ++i) {
    std::vector<std::string> values;
    for (const NamedValues& axis : found) {
      values.push_back(axis[i].second);
    }
    settings.assign(found.front()[i].first, join_text(values, ","));
  }
  return settings;
}

// The learner of one axis with kelpie's own values.
ModelSettings one_axis_learner(std::size_t axes) {
  return with(ModelSettings::from_preset("default", axes),
              {{"learner", "svr"}, {"terms", "fossen"}, {"warmup", "200"}});
}

const NamedValues kTerms{{"terms", "fossen"}, {"lambda", "0.5"}};
const NamedValues kFine{{"fine", "0.7"}};
const NamedValues kOutlier{{"outlier", "robust"}};
const NamedValues kAge{{"forget", "age"}};

// A row of the paper's learner with these settings over the values found.
Row paper_row(const char* key, RowKind kind, const char* name,
              std::vector<NamedValues> changes = {}, bool searched = true, bool slow = false) {
  return {
      key,
      kind,
      name,
      searched ? "paper" : "",
      [changes = std::move(changes)](const Row& row, const AxisValues& found, std::size_t axes) {
        ModelSettings settings = paper_settings(found, axes);
        for (const NamedValues& values : changes) {
          settings = with(std::move(settings), values);
        }
        return online_svr_contender(row.key, row.name, settings);
      },
      slow};
}

Row rls_row(const char* key, const char* name, double lambda) {
  return {
      key, RowKind::baseline, name, {}, [lambda](const Row& row, const AxisValues&, std::size_t) {
        return rls_contender(row.key, lambda);
      }};
}

}  // namespace

Contender online_svr_contender(std::string key, std::string name, const ModelSettings& settings) {
  return {std::move(key), std::move(name), text_of(settings),
          [settings](const log::Dataset& data, std::span<const AxisScaling> scales) {
            return axis_list(data, scales,
                             [&](std::size_t axis, const std::optional<AxisScaling>& scaling) {
                               return online_svr(data, axis, settings, scaling);
                             });
          },
          settings.shared};
}

Contender model_contender(std::string key, std::string name, const ModelSettings& settings) {
  return {std::move(key), std::move(name), text_of(settings),
          [settings](const log::Dataset& data, std::span<const AxisScaling> scales) {
            const bool takes_scales = settings.shared.learner == LearnerKind::svr;
            return scales.empty() || !takes_scales
                       ? std::make_unique<DynamicsModel>(data.input_names, data.target_names,
                                                         settings)
                       : std::make_unique<DynamicsModel>(data.input_names, data.target_names,
                                                         settings, scales);
          },
          settings.shared};
}

Contender sosvr_contender(int dictionary, const AxisValues& values) {
  std::string text;
  for (const NamedValues& axis : values.empty() ? AxisValues{{}} : values) {
    text += (text.empty() ? "" : "; ") +
            text_of(sparse_online_svr_fields(), sosvr_settings(dictionary, axis));
  }
  return {"sosvr", "SOSVR", std::move(text),
          [dictionary, values](const log::Dataset& data, std::span<const AxisScaling> scales) {
            return axis_list(
                data, scales, [&](std::size_t axis, const std::optional<AxisScaling>& scaling) {
                  return std::make_unique<ScaledSosvr>(
                      data.input_names.size(),
                      sosvr_settings(dictionary, values.empty() ? NamedValues{} : values.at(axis)),
                      scaling);
                });
          }};
}

Contender rls_contender(std::string key, double lambda) {
  RecursiveLeastSquaresSettings settings;
  settings.lambda = lambda;
  return {std::move(key), fmt::format("RLS, λ {}", lambda),
          text_of(recursive_least_squares_fields(), settings),
          [settings](const log::Dataset& data, std::span<const AxisScaling> scales) {
            return axis_list(data, scales, [&](std::size_t, const std::optional<AxisScaling>&) {
              return std::make_unique<RecursiveLeastSquares>(data.input_names, settings);
            });
          }};
}

const std::vector<Row>& reproduction_rows() {
  using enum RowKind;
  static const std::vector<Row> rows{
      paper_row("paper", paper, "the paper, settings searched"),
      paper_row("paper_readable", paper, "the paper, Table I, γ as a reciprocal", {}, false),
      paper_row("paper_printed", paper, "the paper, Table I as printed", {{{"gamma", "100,40,20"}}},
                false, true),
      paper_row("fifo", baseline, "FIFO", {{{"forget", "fifo"}}}),
      {"sosvr", baseline, "SOSVR", "sosvr",
       [](const Row&, const AxisValues& found, std::size_t) {
         return sosvr_contender(kBuffer, found);
       }},
      rls_row("rls", "RLS, λ 0.999", 0.999),
      rls_row("rls_all", "RLS, λ 1", 1.0),
      rls_row("rls_short", "RLS, λ 0.98", 0.98),
      paper_row("terms", addition, "paper + physics terms", {kTerms}),
      paper_row("fine", addition, "paper + fine kernel", {kFine}),
      paper_row("outlier", addition, "paper + robust outlier rule", {kOutlier}),
      paper_row("age", addition, "paper + true age", {kAge}),
      paper_row("four", addition, "paper + all four", {kTerms, kFine, kOutlier, kAge}),
      {"svr",
       addition,
       "kelpie's learner of one axis",
       {},
       [](const Row& row, const AxisValues&, std::size_t axes) {
         return online_svr_contender(row.key, row.name, one_axis_learner(axes));
       }},
      {"default",
       kelpie,
       "kelpie's default",
       {},
       [](const Row& row, const AxisValues&, std::size_t axes) {
         return model_contender(row.key, row.name, ModelSettings::from_preset("default", axes));
       }},
      paper_row("paper_small", paper, "the paper, buffer 300", {{{"buffer", "300"}}}),
      paper_row("fifo_small", baseline, "FIFO, buffer 300",
                {{{"buffer", "300"}, {"forget", "fifo"}}}),
  };
  return rows;
}

const std::vector<Family>& searched_families() {
  static const std::vector<Family> families{
      {"paper",
       {{"gamma", {"0.03", "0.01", "0.1", "0.3"}},
        {"epsilon", {"0.1", "0.05", "0.2"}},
        {"c", {"10", "3", "30"}},
        {"xi", {"0.99", "0.97", "0.9"}},
        {"k", {"10", "1", "100"}}},
       {{"gamma", {"0.03", "0.1"}}, {"epsilon", {"0.1", "0.05"}}},
       [](const log::Dataset& data, std::size_t axis, const NamedValues& values) {
         return online_svr(data, axis, with(ModelSettings::from_preset("paper", 3), values), {});
       }},
      {"sosvr",
       {{"gamma", {"0.1", "0.03", "0.3"}},
        {"threshold", {"0.01", "0.03"}},
        {"fade_s", {"600", "100000"}},
        {"c", {"10", "100"}}},
       {{"gamma", {"0.1", "0.3"}}, {"threshold", {"0.01"}}},
       [](const log::Dataset& data, std::size_t, const NamedValues& values) {
         return std::make_unique<ScaledSosvr>(data.input_names.size(),
                                              sosvr_settings(kBuffer, values), std::nullopt);
       }}};
  return families;
}

std::vector<Contender> peer_contenders() {
  const ModelSettings ours = with(one_axis_learner(1), {{"gamma", "0.25"},
                                                        {"fine", "0"},
                                                        {"lambda", "1.5"},
                                                        {"c", "20"},
                                                        {"epsilon", "0.055"},
                                                        {"k", "3"},
                                                        {"anchors", "50"}});
  return {online_svr_contender("svr", "learner of one axis", ours),
          online_svr_contender("fifo", "FIFO, same settings", with(ours, {{"forget", "fifo"}})),
          model_contender("default", "kelpie's default", ModelSettings::from_preset("default", 1)),
          sosvr_contender(SparseOnlineSvrSettings{}.dictionary), rls_contender("rls", 0.999)};
}

}  // namespace kelpie::lab
