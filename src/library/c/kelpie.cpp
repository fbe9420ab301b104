// SPDX-License-Identifier: Apache-2.0
#include "kelpie/kelpie.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "c/guarded.hpp"
#include "c/handle.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/vehicle/diagnosis.hpp"

namespace kelpie {
namespace {

static_assert(KELPIE_MOST_INPUTS == kMostInputs);
static_assert(KELPIE_THRUSTER == static_cast<int>(CauseKind::thruster) &&
              KELPIE_FROZEN == static_cast<int>(CauseKind::frozen) &&
              KELPIE_ALL_THRUSTERS == static_cast<int>(CauseKind::all_thrusters) &&
              kCauseKinds == 8);
static_assert(KELPIE_LOOKING == static_cast<int>(FindingState::looking) &&
              KELPIE_UNEXPLAINED == static_cast<int>(FindingState::none) && kFindingStates == 4);
static_assert(KELPIE_MOST_FINDINGS == Diagnosis::kMostFindings);
static_assert(KELPIE_ACCEPTED == static_cast<int>(Verdict::accepted) &&
              KELPIE_CROWDED_OUT == static_cast<int>(Verdict::crowded_out));

// A thread's own, and of a fixed size: telling of a failure neither allocates nor fails.
thread_local std::array<char, 1024> last_error{};

// What every call with a sample has to get right.
std::span<const double> checked(std::size_t model_inputs, std::size_t model_targets,
                                const double* x, std::size_t inputs, const void* y,
                                std::size_t targets) {
  require_pointer("x", x);
  require_pointer("y", y);
  require_size("x", inputs, model_inputs);
  require_size("y", targets, model_targets);
  return {x, inputs};
}

std::span<const double> checked(const kelpie_model* model, const double* x, std::size_t inputs,
                                const void* y, std::size_t targets) {
  require_pointer("model", model);
  return checked(model->inputs.size(), model->targets.size(), x, inputs, y, targets);
}

std::span<const double> checked(const kelpie_trained* model, const double* x, std::size_t inputs,
                                const void* y, std::size_t targets) {
  require_pointer("model", model);
  return checked(model->model.input_names.size(), model->targets.size(), x, inputs, y, targets);
}

// Nothing is read where the count can't be right.
std::vector<std::string> names_of(const char* what, const char* const* names, std::size_t count,
                                  std::size_t most) {
  require_pointer(what, names);
  require(count <= most, what,
          std::to_string(count) + " given; a model takes at most " + std::to_string(most));
  for (std::size_t i = 0; i < count; ++i) {
    require_pointer(what, names[i]);
  }
  return {names, names + count};
}

kelpie_decision summary(const Decision& decision) {
  return {.predicted = decision.prediction.value,
          .lower = decision.prediction.lower,
          .upper = decision.prediction.upper,
          .changed_since = decision.changed_since,
          .recalled = decision.recalled,
          .verdict = static_cast<std::int32_t>(decision.verdict),
          .had_model = decision.had_model ? 1 : 0,
          .served = decision.published ? 1 : 0,
          .changed = decision.changed ? 1 : 0};
}

kelpie_prediction in_c(const Prediction& prediction) {
  return {.value = prediction.value,
          .lower = prediction.lower,
          .upper = prediction.upper,
          .novelty = prediction.novelty,
          .disturbance = prediction.disturbance,
          .corrected_lower = prediction.corrected_lower,
          .corrected_upper = prediction.corrected_upper};
}

void give_decisions(const kelpie_model& model, kelpie_decision* decisions) {
  if (decisions != nullptr) {
    std::ranges::transform(model.model().decisions(), decisions, summary);
  }
}

kelpie_cause in_c(const Cause& cause) {
  return {.kind = static_cast<std::int32_t>(cause.kind),
          .place = static_cast<std::int32_t>(cause.place),
          .size = cause.size,
          .lower = cause.lower,
          .upper = cause.upper};
}

kelpie_finding in_c(const Finding& finding) {
  return {.since_s = finding.since_s,
          .found_s = finding.found_s,
          .told_s = finding.told_s,
          .state = static_cast<std::int32_t>(finding.state),
          .settled = finding.settled ? 1 : 0,
          .count = static_cast<std::int32_t>(finding.count),
          .reserved = 0,
          .causes = {in_c(finding.causes[0]), in_c(finding.causes[1])},
          .rival = in_c(finding.rival)};
}

// Runs `predict(predictions)`, and gives the predictions to C unless it says that there are none.
template <typename Predict>
void give_predictions(kelpie_prediction* y, std::size_t targets, const Predict& predict) {
  std::array<Prediction, KELPIE_MOST_TARGETS> predicted;
  const auto all = std::span(predicted).first(targets);
  if (predict(all)) {
    std::ranges::transform(all, y, [](const Prediction& one) { return in_c(one); });
  }
}

void give_number(std::int64_t* place, std::int64_t number) {
  if (place != nullptr) {
    *place = number;
  }
}

const char* name_of(const std::vector<std::string>& names, std::size_t i) {
  return i < names.size() ? names[i].c_str() : nullptr;
}

}  // namespace

void keep_error(const char* message) {
  std::strncpy(last_error.data(), message, last_error.size() - 1);
}

}  // namespace kelpie

const char* kelpie_last_error() {
  return kelpie::last_error.data();
}

const char* kelpie_version() {
  return KELPIE_VERSION;
}

kelpie_status kelpie_create(const char* const* inputs, size_t input_count,
                            const char* const* targets, size_t target_count, const char* settings,
                            kelpie_model** model) {
  return kelpie::guarded([&] {
    kelpie::require_pointer("model", model);
    *model = kelpie::made(kelpie::names_of("inputs", inputs, input_count, KELPIE_MOST_INPUTS),
                          kelpie::names_of("targets", targets, target_count, KELPIE_MOST_TARGETS),
                          settings == nullptr ? "" : settings)
                 .release();
  });
}

void kelpie_free(kelpie_model* model) {
  delete model;  // NOLINT(cppcoreguidelines-owning-memory): C owns it
}

size_t kelpie_input_count(const kelpie_model* model) {
  return model->inputs.size();
}

size_t kelpie_target_count(const kelpie_model* model) {
  return model->targets.size();
}

const char* kelpie_input_name(const kelpie_model* model, size_t i) {
  return kelpie::name_of(model->inputs, i);
}

const char* kelpie_target_name(const kelpie_model* model, size_t i) {
  return kelpie::name_of(model->targets, i);
}

kelpie_status kelpie_update(kelpie_model* model, const double* x, size_t inputs, const double* y,
                            size_t targets, double t, kelpie_decision* decisions) {
  return kelpie::guarded([&] {
    const auto sample = kelpie::checked(model, x, inputs, y, targets);
    if (model->own == nullptr) {
      throw kelpie::InputError("model",
                               "belongs to a kelpie_shared, which kelpie_shared_update() teaches");
    }
    model->own->update(sample, {y, targets}, t);
    kelpie::give_decisions(*model, decisions);
  });
}

int kelpie_ready(const kelpie_model* model) {
  return model->model().ready() ? 1 : 0;
}

kelpie_status kelpie_predict(const kelpie_model* model, const double* x, size_t inputs, double* y,
                             size_t targets) {
  return kelpie::guarded([&] {
    const auto place = kelpie::checked(model, x, inputs, y, targets);
    model->model().predict(place, std::span(y, targets));
  });
}

kelpie_status kelpie_predict_with_jacobian(const kelpie_model* model, const double* x,
                                           size_t inputs, double* y, size_t targets,
                                           double* jacobian) {
  return kelpie::guarded([&] {
    const auto place = kelpie::checked(model, x, inputs, y, targets);
    kelpie::require_pointer("jacobian", jacobian);
    model->model().predict_with_jacobian(place, {y, targets}, {jacobian, targets * inputs});
  });
}

kelpie_status kelpie_assess(const kelpie_model* model, const double* x, size_t inputs,
                            kelpie_prediction* y, size_t targets, double ahead_s) {
  return kelpie::guarded([&] {
    const auto place = kelpie::checked(model, x, inputs, y, targets);
    kelpie::give_predictions(y, targets, [&](auto all) {
      model->model().predict(place, all, ahead_s);
      return true;
    });
  });
}

kelpie_status kelpie_save(const kelpie_model* model, unsigned char** bytes, size_t* size) {
  return kelpie::guarded([&] {
    kelpie::require_pointer("model", model);
    kelpie::require_pointer("bytes", bytes);
    kelpie::require_pointer("size", size);
    const std::string saved = kelpie::saved(*model);
    auto copy = std::make_unique<unsigned char[]>(saved.size());  // NOLINT: C's way to hold them
    std::memcpy(copy.get(), saved.data(), saved.size());
    *bytes = copy.release();
    *size = saved.size();
  });
}

// NOLINTNEXTLINE(readability-non-const-parameter): whoever frees takes what was given
void kelpie_free_bytes(unsigned char* bytes) {
  delete[] bytes;  // NOLINT(cppcoreguidelines-owning-memory): C owns them
}

kelpie_status kelpie_load(const unsigned char* bytes, size_t size, kelpie_model** model) {
  return kelpie::guarded([&] {
    kelpie::require_pointer("bytes", bytes);
    kelpie::require_pointer("model", model);
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): bytes are bytes
    *model = kelpie::loaded({reinterpret_cast<const char*>(bytes), size}).release();
  });
}

kelpie_status kelpie_findings(const kelpie_model* model, kelpie_finding* findings, size_t room,
                              size_t* count) {
  return kelpie::guarded([&] {
    kelpie::require_pointer("model", model);
    kelpie::require_pointer("count", count);
    if (room > 0) {
      kelpie::require_pointer("findings", findings);
    }
    const std::vector<kelpie::Finding> all = model->model().findings();
    std::ranges::transform(std::span(all).first(std::min(room, all.size())), findings,
                           [](const kelpie::Finding& one) { return kelpie::in_c(one); });
    *count = all.size();
  });
}

kelpie_status kelpie_finding_text(const kelpie_model* model, size_t i, char* text, size_t size) {
  return kelpie::guarded([&] {
    kelpie::require_pointer("model", model);
    kelpie::require_pointer("text", text);
    const std::vector<kelpie::Finding> all = model->model().findings();
    kelpie::require(i < all.size(), "i", "there are " + std::to_string(all.size()) + " findings");
    kelpie::require(size > 0, "size", "has to be 1 or more");
    const std::string words = kelpie::finding_text(all[i], {model->inputs, model->targets});
    text[words.copy(text, size - 1)] = '\0';
  });
}

kelpie_status kelpie_share(kelpie_model* model, kelpie_shared** shared) {
  return kelpie::guarded([&] {
    kelpie::require_pointer("model", model);
    kelpie::require_pointer("shared", shared);
    kelpie::require(model->own != nullptr, "model", "is shared already");
    auto whole = std::make_unique<kelpie_shared>();
    auto next = std::make_unique<kelpie::SharedModel>(*model->own);
    model->shared = std::move(next);
    model->own.reset();
    whole->model.reset(model);
    *shared = whole.release();
  });
}

void kelpie_free_shared(kelpie_shared* shared) {
  delete shared;  // NOLINT(cppcoreguidelines-owning-memory): C owns it
}

const kelpie_model* kelpie_shared_model(const kelpie_shared* shared) {
  return shared->model.get();
}

kelpie_status kelpie_shared_update(kelpie_shared* shared, const double* x, size_t inputs,
                                   const double* y, size_t targets, double t,
                                   kelpie_decision* decisions) {
  return kelpie::guarded([&] {
    kelpie::require_pointer("shared", shared);
    const auto sample = kelpie::checked(shared->model.get(), x, inputs, y, targets);
    shared->model->shared->update(sample, {y, targets}, t);
    kelpie::give_decisions(*shared->model, decisions);
  });
}

kelpie_status kelpie_shared_assess(const kelpie_shared* shared, const double* x, size_t inputs,
                                   kelpie_prediction* y, size_t targets, double ahead_s,
                                   int64_t* snapshot) {
  return kelpie::guarded([&] {
    kelpie::require_pointer("shared", shared);
    const auto place = kelpie::checked(shared->model.get(), x, inputs, y, targets);
    kelpie::give_predictions(y, targets, [&](auto all) {
      const std::int64_t number = shared->model->shared->predict(place, all, ahead_s);
      kelpie::give_number(snapshot, number);
      return number > 0;
    });
  });
}

kelpie_status kelpie_shared_predict_with_jacobian(const kelpie_shared* shared, const double* x,
                                                  size_t inputs, double* y, size_t targets,
                                                  double* jacobian, int64_t* snapshot) {
  return kelpie::guarded([&] {
    kelpie::require_pointer("shared", shared);
    const auto place = kelpie::checked(shared->model.get(), x, inputs, y, targets);
    kelpie::require_pointer("jacobian", jacobian);
    kelpie::give_number(snapshot, shared->model->shared->predict_with_jacobian(
                                      place, {y, targets}, {jacobian, targets * inputs}));
  });
}

kelpie_status kelpie_shared_serve(kelpie_shared* shared, void* block, size_t bytes) {
  return kelpie::guarded([&] {
    kelpie::require_pointer("shared", shared);
    kelpie::require(block != nullptr || bytes == 0, "block", "is null");
    const kelpie_model& model = *shared->model;
    model.shared->serve({static_cast<std::byte*>(block), bytes}, model.inputs, model.targets);
  });
}

kelpie_status kelpie_read_trained(const char* json, size_t size, kelpie_trained** model) {
  return kelpie::guarded([&] {
    kelpie::require_pointer("json", json);
    kelpie::require_pointer("model", model);
    kelpie::TrainedModel read = kelpie::read_trained_model({json, size});
    std::vector<std::string> targets = read.target_names();
    std::string alignment = read.alignment.none() ? "" : read.alignment.text();
    *model = std::make_unique<kelpie_trained>(
                 kelpie_trained{std::move(read), std::move(targets), std::move(alignment)})
                 .release();
  });
}

void kelpie_free_trained(kelpie_trained* model) {
  delete model;  // NOLINT(cppcoreguidelines-owning-memory): C owns it
}

size_t kelpie_trained_input_count(const kelpie_trained* model) {
  return model->model.input_names.size();
}

size_t kelpie_trained_target_count(const kelpie_trained* model) {
  return model->targets.size();
}

const char* kelpie_trained_input_name(const kelpie_trained* model, size_t i) {
  return kelpie::name_of(model->model.input_names, i);
}

const char* kelpie_trained_target_name(const kelpie_trained* model, size_t i) {
  return kelpie::name_of(model->targets, i);
}

const char* kelpie_trained_alignment(const kelpie_trained* model) {
  return model->alignment.c_str();
}

kelpie_status kelpie_trained_predict(const kelpie_trained* model, const double* x, size_t inputs,
                                     double* y, size_t targets) {
  return kelpie::guarded([&] {
    const auto place = kelpie::checked(model, x, inputs, y, targets);
    model->model.predict(place, std::span(y, targets));
  });
}

kelpie_status kelpie_trained_assess(const kelpie_trained* model, const double* x, size_t inputs,
                                    kelpie_prediction* y, size_t targets) {
  return kelpie::guarded([&] {
    const auto place = kelpie::checked(model, x, inputs, y, targets);
    kelpie::give_predictions(y, targets, [&](auto all) {
      model->model.predict(place, all);
      return true;
    });
  });
}

kelpie_status kelpie_trained_predict_with_jacobian(const kelpie_trained* model, const double* x,
                                                   size_t inputs, double* y, size_t targets,
                                                   double* jacobian) {
  return kelpie::guarded([&] {
    const auto place = kelpie::checked(model, x, inputs, y, targets);
    kelpie::require_pointer("jacobian", jacobian);
    model->model.predict_with_jacobian(place, {y, targets}, {jacobian, targets * inputs});
  });
}
