// SPDX-License-Identifier: Apache-2.0
#include "kelpie/online/online_svr.hpp"

#include <numeric>
#include <optional>

#include "kelpie/online/valid_sample.hpp"

namespace kelpie {
namespace {

OnlineSvrSettings validated(const OnlineSvrSettings& settings) {
  settings.validate();
  return settings;
}

}  // namespace

OnlineSvr::OnlineSvr(std::size_t inputs, const OnlineSvrSettings& settings)
    : settings_(validated(settings)),
      gate_(settings_),
      buffer_(inputs, settings_),
      solver_(settings_.tolerance, settings_.max_iterations),
      filter_(settings_),
      forgetting_(settings_),
      model_(buffer_.kernel(), inputs, buffer_.samples().capacity()) {}

Decision OnlineSvr::update(std::span<const double> z, double y, double t) {
  Decision decision;
  include(decision, z, y, t);  // including, eq. (9), (10)
  if (decision.verdict == Verdict::accepted) {
    buffer_.collect(z, y, t);  // sample collector
  }
  if (decision.verdict == Verdict::accepted || !solved_.converged) {
    train(decision);      // training, eq. (4)
    reject(decision);     // outlier rejection, eq. (11), (12)
    forget(decision, t);  // forgetting, eq. (7), (8)
    repair(decision);     // training again, where a weight was pruned
    serve(decision);
  }
  count(decision);
  return decision;
}

double OnlineSvr::predict(std::span<const double> z) const {
  return status_.ready ? model_(z) : mean_;
}

Status OnlineSvr::status() const {
  Status status = status_;
  status.buffer = static_cast<int>(buffer_.size());
  status.support_vectors = static_cast<int>(buffer_.support_vectors());
  return status;
}

void OnlineSvr::include(Decision& decision, std::span<const double> z, double y, double t) {
  decision.had_model = status_.ready;
  decision.kkt_gap = status_.kkt_gap;
  if (!valid_sample(z, buffer_.samples().dimension(), y, t)) {
    decision.verdict = Verdict::invalid;
    return;
  }
  const std::span<const double> similarity = buffer_.similarity(z);
  decision.predicted = predicted(z, similarity);
  if (status_.ready) {
    filter_.observe(y - decision.predicted);
  }
  mean_ += (y - mean_) / static_cast<double>(++valid_samples_);
  decision.verdict = gate_.judge(similarity, buffer_.problem().targets(), decision.predicted, y);
}

// The row at hand gives the model in service for nothing, unless an older one is in service.
double OnlineSvr::predicted(std::span<const double> z, std::span<const double> similarity) const {
  if (!current_) {
    return predict(z);
  }
  const std::span<const double> beta = buffer_.problem().beta();
  return std::inner_product(beta.begin(), beta.end(), similarity.begin(), model_.bias());
}

void OnlineSvr::train(Decision& decision) {
  solved_ = solver_.solve(buffer_.problem());
  decision.iterations += solved_.iterations;
  decision.kkt_gap = solved_.kkt_gap;
}

void OnlineSvr::reject(Decision& decision) {
  for (const std::size_t i : filter_.judge(buffer_, buffer_.problem().kkt().bias())) {
    remove(i);
    ++decision.outliers;
  }
}

void OnlineSvr::forget(Decision& decision, double now) {
  while (true) {
    const std::optional<std::size_t> i = forgetting_.released(buffer_);
    if (!i) {
      break;
    }
    remove(*i);
    ++decision.released;
  }
  while (true) {
    const std::optional<std::size_t> i = forgetting_.forgotten(buffer_, now);
    if (!i) {
      break;
    }
    remove(*i);
    ++decision.forgotten;
  }
}

void OnlineSvr::repair(Decision& decision) {
  if (pruned_weight_) {
    train(decision);
    pruned_weight_ = false;
  }
}

void OnlineSvr::serve(Decision& decision) {
  current_ = solved_.converged && buffer_.size() > 0;
  decision.served = current_;
  if (current_) {
    const DualProblem& problem = buffer_.problem();
    model_.assign(buffer_.samples(), problem.beta(), problem.kkt().bias());
    status_.kkt_gap = solved_.kkt_gap;
    status_.ready = true;
  }
}

void OnlineSvr::remove(std::size_t i) {
  pruned_weight_ = pruned_weight_ || !buffer_.idle(i);
  buffer_.remove(i);
}

void OnlineSvr::count(const Decision& decision) {
  Tally& tally = status_.tally;
  tally.accepted += decision.verdict == Verdict::accepted ? 1 : 0;
  tally.explained += decision.verdict == Verdict::explained ? 1 : 0;
  tally.duplicate += decision.verdict == Verdict::duplicate ? 1 : 0;
  tally.invalid += decision.verdict == Verdict::invalid ? 1 : 0;
  tally.outliers += decision.outliers;
  tally.forgotten += decision.forgotten;
  tally.released += decision.released;
  tally.unserved += solved_.converged ? 0 : 1;
}

}  // namespace kelpie
