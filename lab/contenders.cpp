// SPDX-License-Identifier: Apache-2.0
#include "lab/contenders.hpp"

#include <fmt/format.h>

#include <optional>
#include <span>
#include <utility>

#include "kelpie/core/setting.hpp"
#include "kelpie/learner/recursive_least_squares.hpp"
#include "kelpie/motion/term_set.hpp"
#include "lab/sparse_online_svr.hpp"
#include "model/guarded_axis.hpp"

namespace kelpie::lab {
namespace {

// To follow a change a learner has to forget: about 1,000 samples of memory.
constexpr double kLambda = 0.999;

// SOSVR wants scaled samples, and stays in the scale that it began with.
class ScaledSosvr final : public Scaled {
 public:
  ScaledSosvr(std::size_t inputs, const SparseOnlineSvrSettings& settings,
              std::optional<AxisScaling> scaling)
      : Scaled(inputs, SharedSettings{}, {}, std::move(scaling)), learner_(inputs, settings) {}

 private:
  SparseOnlineSvr& learner() override { return learner_; }
  const SparseOnlineSvr& learner() const override { return learner_; }

  SparseOnlineSvr learner_;
};

template <typename Settings>
std::string text_of(std::span<const Setting<Settings>> fields, const Settings& settings) {
  std::string text;
  for (const Setting<Settings>& field : fields) {
    text += fmt::format("{}{}={}", text.empty() ? "" : " ", field.name, field.get(settings));
  }
  return text;
}

// The paper's learner alone, with the default preset's values and Fossen's terms.
ModelSettings paper_learner(std::size_t axes) {
  ModelSettings settings = ModelSettings::from_preset("default", axes);
  settings.assign("learner", "svr");
  settings.assign("terms", "fossen");
  settings.assign("warmup", "200");
  return settings;
}

Contender committee_contender(std::size_t axes) {
  return online_svr_contender("default", "committee: default preset",
                              ModelSettings::from_preset("default", axes));
}

// The same learner but for who is forgotten.
Contender fifo_twin(std::string key, std::string name, const Contender& twin,
                    ModelSettings settings) {
  settings.assign("forget", "fifo");
  settings.assign("adapt", "none");
  Contender fifo = online_svr_contender(std::move(key), std::move(name), settings);
  fifo.twin = twin.key;
  return fifo;
}

}  // namespace

Contender online_svr_contender(std::string key, std::string name, const ModelSettings& settings) {
  settings.validate();
  std::string text;
  for (const auto& [field, value] : settings.values()) {
    text += fmt::format("{}{}={}", text.empty() ? "" : " ", field, value);
  }
  return {std::move(key), std::move(name), std::move(text),
          [settings](std::span<const std::string> inputs, std::size_t axis,
                     std::optional<AxisScaling> scaling) {
            const TermSet terms =
                TermSet::from(settings.shared.terms, inputs, settings.axes.size());
            return std::make_unique<GuardedAxis>(inputs.size(), settings.shared,
                                                 settings.axes.at(axis), terms, std::move(scaling));
          },
          settings.shared};
}

Contender sosvr_contender() {
  const SparseOnlineSvrSettings settings;
  return {"sosvr", "SOSVR", text_of(sparse_online_svr_fields(), settings),
          [settings](std::span<const std::string> inputs, std::size_t /*axis*/,
                     std::optional<AxisScaling> scaling) {
            return std::make_unique<ScaledSosvr>(inputs.size(), settings, std::move(scaling));
          }};
}

Contender rls_contender(std::string key, double lambda) {
  RecursiveLeastSquaresSettings settings;
  settings.lambda = lambda;
  return {std::move(key), fmt::format("RLS, λ {}", lambda),
          text_of(recursive_least_squares_fields(), settings),
          [settings](std::span<const std::string> inputs, std::size_t /*axis*/,
                     const std::optional<AxisScaling>& /*scaling*/) {
            return std::make_unique<RecursiveLeastSquares>(inputs, settings);
          }};
}

std::vector<Contender> paper_contenders(std::size_t axes) {
  const ModelSettings ours = paper_learner(axes);
  const Contender proposed = online_svr_contender("proposed", "proposed", ours);
  return {proposed,
          fifo_twin("fifo", "FIFO", proposed, ours),
          committee_contender(axes),
          sosvr_contender(),
          rls_contender("rls", kLambda),
          rls_contender("rls_all", 1.0),
          rls_contender("rls_short", 0.98),
          online_svr_contender("paper", "paper's values as written",
                               ModelSettings::from_preset("paper", axes))};
}

std::vector<Contender> peer_contenders() {
  ModelSettings ours = paper_learner(1);
  for (const auto& [name, value] : {std::pair{"gamma", "0.25"},
                                    {"fine", "0"},
                                    {"lambda", "1.5"},
                                    {"c", "20"},
                                    {"epsilon", "0.055"},
                                    {"k", "3"},
                                    {"anchors", "50"}}) {
    ours.assign(name, value);
  }
  const Contender proposed = online_svr_contender("proposed", "proposed", ours);
  return {proposed, fifo_twin("fifo", "FIFO, same settings", proposed, ours),
          committee_contender(1), sosvr_contender(), rls_contender("rls", kLambda)};
}

std::vector<Contender> small_buffer_contenders(std::size_t axes, int buffer) {
  ModelSettings ours = paper_learner(axes);
  ours.assign("buffer", std::to_string(buffer));
  const Contender proposed =
      online_svr_contender("proposed_small", fmt::format("proposed, buffer {}", buffer), ours);
  return {proposed,
          fifo_twin("fifo_small", fmt::format("FIFO, buffer {}", buffer), proposed, ours)};
}

}  // namespace kelpie::lab
