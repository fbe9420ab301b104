// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "kelpie/model/stored_past_model.hpp"
#include "model/dynamics_axis.hpp"
#include "model/expected_target.hpp"
#include "model/model_axis.hpp"
#include "model/thinned_rows.hpp"

namespace kelpie {

/// An axis guarded against garbage: a scale is trusted after probation only.
///
/// A sample more than 10 standard deviations away is implausible for an axis, with two exceptions:
/// inputs that were held, after the first half minute (ScaleTracker), and a target that follows
/// from physics (ExpectedTarget), with inputs within the scale. The trusted axis never
/// learns implausible samples, or samples among these. When implausible samples have come for half
/// a second, a candidate, a copy of the trusted axis, learns these samples, and the scale of the
/// candidate follows. The candidate is in service after inputs more than 10 standard deviations
/// away, the trusted axis after all other samples. After a minute without such samples the
/// candidate begins as a copy again, since the trusted axis has learned meanwhile, and learns the
/// implausible samples kept. Samples beyond the scale of the candidate, too, for half a second,
/// widen this scale; samples wait until the scale is in use. The candidate takes the place of the
/// trusted axis when implausible samples have come for 36 s (garbage of a sensor lasts up to 30 s),
/// or when the candidate explains half of the variance of these samples, within stretches of them:
/// a sensor that is stuck explains its next stretch.
///
/// A scale may be too large as well, after garbage in the first samples. During the first 90 s, and
/// for 60 s after a candidate took over that did not explain half, the guard looks every 5 s at the
/// later half of the samples: when the target or an input stays within 0.12 standard deviations and
/// within 0.36 of zero, and the axis explains next to nothing, this axis becomes the candidate. The
/// axis that was trusted before the candidate took over is trusted again, if this axis was older
/// than 90 s, or else a new axis; the axis learns this half. A candidate with too large a scale
/// begins again in the same way. But the vehicle may have moved first, and then hardly: the former
/// axis stays the candidate, and is trusted again when this axis explains half of the variance of
/// the next 20 implausible samples or more; where it explains next to nothing of 20, or less than
/// half of 100, it was one of garbage.
///
/// Before all this, while the trusted axis holds its first samples back for a scale, a candidate
/// with a scale of ten samples learns these samples and is in service.
///
/// One axis learns a sample, so that the guard adds no work to an update, except to the first
/// updates, and to the few in which a candidate begins. Without `track`, every sample is plausible,
/// and no candidate is in service.
class GuardedAxis final : public ModelAxis {
 public:
  /// As DynamicsAxis.
  GuardedAxis(std::size_t inputs, const SharedSettings& shared, const OnlineSvrSettings& settings,
              const TermSet& terms, std::optional<AxisScaling> scaling = {});

  void limit(const Budget& budget) override;  ///< Committee::limit().

  /// Allocates as DynamicsAxis, and for a new axis in place of a scale too large.
  Decision update(std::span<const double> x, double y, double t) override;
  void alert(double since_s, bool another) override;
  void learn_held_back() override;

  double predict(std::span<const double> x) const override { return in_service().predict(x); }
  Prediction assess(std::span<const double> x) const override { return in_service().assess(x); }
  Prediction assess(std::span<const double> x, double ahead_s) const override {
    return in_service().assess(x, ahead_s);
  }
  double predict_with_gradient(std::span<const double> x,
                               std::span<double> gradient) const override {
    return in_service().predict_with_gradient(x, gradient);
  }

  /// Of the axis in service; totals count the samples of all axes.
  Status status() const override;
  std::vector<Coefficient> coefficients() const override { return in_service().coefficients(); }

  /// The axis that predicts.
  const DynamicsAxis& in_service() const { return candidate_serves_ ? candidate() : trusted(); }
  /// Of the trusted axis.
  std::vector<StoredPastModel> past_models() const override { return trusted().past_models(); }

  /// DynamicsAxis::apply_change() of the trusted axis, and of an axis that may take its place.
  void apply_change(std::span<const CommandGain> gains, std::span<const double> step,
                    const Decision& news) override;

  /// DynamicsAxis::expect_vehicle(). A further axis that begins anew begins with these, too.
  void expect_vehicle(std::vector<double> coefficients) override;

  /// DynamicsAxis::set_past_models().
  void set_past_models(std::vector<StoredPastModel> models) override {
    for (const StoredPastModel& one : models) {
      require(!one.targets.empty(), "past models", "hold no samples, which this learner needs");
    }
    given_ = models;
    trusted().set_past_models(std::move(models));
  }

  /// Whether the last sample was learned, or held back, by the trusted axis.
  bool trusted_last() const override { return trusted_last_; }

  /// DynamicsAxis::resume_from().
  void resume_from(const Snapshot& trained, double t) override;

  void visit(Archive& archive) override;  ///< core/archive.hpp

  /// Memory in bytes, for an axis of `axis` bytes: two axes, the doubtful samples, and what physics
  /// leads to expect.
  static std::size_t bytes(std::size_t inputs, std::size_t terms, std::size_t axis) {
    return 2 * axis + 4 * ThinnedRows::kMost * (inputs + 2) * sizeof(double) +
           ExpectedTarget::bytes(terms);
  }

 private:
  std::unique_ptr<ModelAxis> clone() const override { return std::make_unique<GuardedAxis>(*this); }
  const DynamicsAxis& dynamics_axis() const override { return in_service(); }
  const TermSet& terms() const override { return in_service().terms(); }
  const AxisScaling* scaling() const override { return in_service().scaling(); }
  Snapshot snapshot() const override { return in_service().snapshot(); }
  void refresh(Snapshot& copy) const override { in_service().refresh(copy); }
  Snapshot trained(std::string name) const override {
    return in_service().trained(std::move(name));
  }
  bool unfinished() const override { return in_service().svr().champion().unfinished(); }
  std::vector<MemberShare> members() const override { return in_service().members(); }

  /// Arguments of the constructor.
  struct Arguments {
    std::size_t inputs;
    SharedSettings shared;
    OnlineSvrSettings settings;
    TermSet terms;
    std::optional<AxisScaling> scaling;
    DynamicsAxis make() const { return {inputs, shared, settings, terms, scaling}; }
    DynamicsAxis make_early() const;  ///< With a scale of few samples.
  };

  /// The role of the axis that is not trusted.
  enum class Other : std::uint8_t {
    none,       ///< kept for the next candidate
    early,      ///< in service with a scale of few samples, until the trusted axis has learned
                ///< the samples held back
    candidate,  ///< on probation, begun as a copy of the trusted axis
    former,     ///< trusted until a candidate took over
    former_on_trial,  ///< on probation, trusted until a new axis began
  };

  /// How well a candidate explains the samples that only the candidate learns.
  struct Evidence {
    double samples = 0.0;
    double of_stretch = 0.0;   ///< samples of the stretch
    double mean = 0.0;         ///< of the targets of the stretch
    double spread = 0.0;       ///< sum of squared deviations from the mean so far
    double unexplained = 0.0;  ///< sum of squared errors
    void add(double said, double was, double scale);
    void begin_stretch();  ///< Samples from now on count from a mean of their own.
    bool moves() const;    ///< Whether the targets have moved enough to be evidence.
    bool convincing() const;
    bool rejects() const;  ///< Whether next to nothing is explained, or less than half for long.
    void visit(Archive& archive);
  };

  bool on_probation() const {
    return other_ == Other::candidate || other_ == Other::former_on_trial;
  }
  const DynamicsAxis& trusted() const { return axes_[trusted_]; }
  DynamicsAxis& trusted() { return axes_[trusted_]; }
  const DynamicsAxis& candidate() const { return axes_[1 - trusted_]; }
  DynamicsAxis& candidate() { return axes_[1 - trusted_]; }
  Decision learn_trusted(std::span<const double> x, double y, double t);
  void end_early();
  Decision learn_doubted(std::span<const double> x, double y, double t, const Prediction& said);
  Decision learn_in_candidate(std::span<const double> x, double y, double t);
  bool plausible(std::span<const double> x, double y, double t) const;
  bool expected(std::span<const double> x, double y) const;
  bool doubtful(std::span<const double> x, double y, double t);
  void count_time(bool refused, double t);
  void doubt(double t);
  void begin_probation(Other other, double t);
  void begin_candidate(double t);
  void renew_candidate(double t);
  void teach_refused(double since_s);
  void drop_candidate();
  void trust_candidate(double t);
  void begin_anew(double t);
  void return_to_former(double t);
  void feed_trusted(std::size_t first);
  void look(double t);
  static bool too_large(const DynamicsAxis& axis, const ThinnedRows& rows);
  void feed();

  Arguments arguments_;
  std::array<DynamicsAxis, 2> axes_;
  std::vector<double> expected_;        ///< coefficients for a new axis; empty: none
  std::vector<StoredPastModel> given_;  ///< for a new axis; own past models are in a wrong scale
  std::size_t trusted_ = 0;             ///< number of the trusted axis
  Other other_;
  bool candidate_serves_;           ///< early, or the inputs of the last sample were far away
  ExpectedTarget expected_target_;  ///< whatever axis is trusted
  bool guarded_;  ///< false without `track`, and once a given scale has proved too small
  bool trusted_last_ = true;

  ThinnedRows first_;        ///< of a young trusted axis
  double young_until_;       ///< [s]; infinite before the first sample
  double held_from_;         ///< [s], from when on inputs may have been held
  ThinnedRows refused_;      ///< implausible samples: of the run, or since the candidate began
  std::int64_t run_ = 0;     ///< implausible samples that no axis learned
  std::int64_t passed_ = 0;  ///< plausible samples among these
  double run_since_ = 0.0;   ///< [s]
  double doubted_s_ = 0.0;   ///< [s], time of the last doubtful sample
  double recent_ = 0.0;      ///< of the last samples, the implausible
  double share_ = 0.0;       ///< of time with implausible samples, exponentially forgotten
  double before_;            ///< [s], time of the last sample
  double next_look_ = 0.0;   ///< [s]
  Evidence evidence_;
  double convincing_from_ = 0.0;  ///< [s], earliest end of probation by evidence
  WarmUp feed_;                   ///< samples that a new axis has still to learn
  bool feeds_trusted_ = false;
  std::int64_t implausible_ = 0;
  Tally begun_with_;  ///< of the candidate, as a copy
  Tally gone_;        ///< of axes that are no more
};

}  // namespace kelpie
