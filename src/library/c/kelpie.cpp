// SPDX-License-Identifier: Apache-2.0
#include "kelpie/kelpie.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <exception>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "c/handle.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie {
namespace {

static_assert(KELPIE_MOST_INPUTS == kMostInputs);
static_assert(KELPIE_ACCEPTED == static_cast<int>(Verdict::accepted) &&
              KELPIE_CROWDED_OUT == static_cast<int>(Verdict::crowded_out));

// A thread's own, and of a fixed size: telling of a failure neither allocates nor fails.
thread_local std::array<char, 1024> last_error{};

void keep_error(const char* message) {
  std::strncpy(last_error.data(), message, last_error.size() - 1);
}

// Runs what may throw.
template <typename Work>
kelpie_status guarded(const Work& work) {
  try {
    work();
    return KELPIE_OK;
  } catch (const InputError& error) {
    keep_error(error.what());
    return KELPIE_BAD_INPUT;
  } catch (const std::exception& error) {
    keep_error(error.what());
  } catch (...) {
    keep_error("something was thrown that is no exception of the standard library");
  }
  return KELPIE_FAILED;
}

void require_pointer(const char* what, const void* pointer) {
  if (pointer == nullptr) {
    throw InputError(what, "is null");
  }
}

// What every call with a sample has to get right.
std::span<const double> checked(const kelpie_model* model, const double* x, std::size_t inputs,
                                const void* y, std::size_t targets) {
  require_pointer("model", model);
  require_pointer("x", x);
  require_pointer("y", y);
  require_size("x", inputs, model->inputs.size());
  require_size("y", targets, model->targets.size());
  return {x, inputs};
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

const char* name_of(const std::vector<std::string>& names, std::size_t i) {
  return i < names.size() ? names[i].c_str() : nullptr;
}

}  // namespace
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
    model->model.update(sample, {y, targets}, t);
    if (decisions != nullptr) {
      std::ranges::transform(model->model.decisions(), decisions, kelpie::summary);
    }
  });
}

int kelpie_ready(const kelpie_model* model) {
  return model->model.ready() ? 1 : 0;
}

kelpie_status kelpie_predict(const kelpie_model* model, const double* x, size_t inputs, double* y,
                             size_t targets) {
  return kelpie::guarded([&] {
    const auto place = kelpie::checked(model, x, inputs, y, targets);
    model->model.predict(place, std::span(y, targets));
  });
}

kelpie_status kelpie_predict_with_jacobian(const kelpie_model* model, const double* x,
                                           size_t inputs, double* y, size_t targets,
                                           double* jacobian) {
  return kelpie::guarded([&] {
    const auto place = kelpie::checked(model, x, inputs, y, targets);
    kelpie::require_pointer("jacobian", jacobian);
    model->model.predict_with_jacobian(place, {y, targets}, {jacobian, targets * inputs});
  });
}

kelpie_status kelpie_assess(const kelpie_model* model, const double* x, size_t inputs,
                            kelpie_prediction* y, size_t targets, double ahead_s) {
  return kelpie::guarded([&] {
    const auto place = kelpie::checked(model, x, inputs, y, targets);
    std::array<kelpie::Prediction, KELPIE_MOST_TARGETS> predicted;
    const auto all = std::span(predicted).first(targets);
    model->model.predict(place, all, ahead_s);
    std::ranges::transform(all, y, kelpie::in_c);
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
