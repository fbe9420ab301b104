// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>

#include "c/guarded.hpp"
#include "c/handle.hpp"
#include "kelpie/navigation/dead_reckoning.hpp"

struct kelpie_reckoning {
  kelpie::DeadReckoning reckoning;
  std::size_t inputs;
};

namespace kelpie {
namespace {

static_assert(KELPIE_VELOCITY_IMPLAUSIBLE == static_cast<int>(VelocityFault::implausible) &&
              KELPIE_VELOCITY_ZERO == static_cast<int>(VelocityFault::zero));
static_assert(KELPIE_COMMANDS_HELD == static_cast<int>(CommandPath::held) &&
              KELPIE_COMMANDS_LINEAR == static_cast<int>(CommandPath::linear));

OpenLoop loop_of(const kelpie_model* model) {
  require_pointer("model", model);
  require(model->model().ready(), "model", "has learned too little so far");
  return open_loop(model->model().trained(), OpenLoopPart::steady);
}

}  // namespace
}  // namespace kelpie

kelpie_status kelpie_reckoning_create(const kelpie_model* model, int planar,
                                      kelpie_reckoning** reckoning) {
  return kelpie::guarded([&] {
    kelpie::require_pointer("reckoning", reckoning);
    const kelpie::OpenLoop loop = kelpie::loop_of(model);
    *reckoning = std::make_unique<kelpie_reckoning>(
                     kelpie_reckoning{kelpie::DeadReckoning(loop, {.planar = planar != 0}),
                                      model->inputs.size()})
                     .release();
  });
}

void kelpie_reckoning_free(kelpie_reckoning* reckoning) {
  delete reckoning;  // NOLINT(cppcoreguidelines-owning-memory): C owns it
}

kelpie_status kelpie_reckoning_use(kelpie_reckoning* reckoning, const kelpie_model* model) {
  return kelpie::guarded([&] {
    kelpie::require_pointer("reckoning", reckoning);
    reckoning->reckoning.use(kelpie::loop_of(model));
  });
}

size_t kelpie_reckoning_states(const kelpie_reckoning* reckoning) {
  return reckoning->reckoning.states();
}

kelpie_status kelpie_reckoning_update(kelpie_reckoning* reckoning, const double* x, size_t inputs,
                                      double t, const double* covariance) {
  return kelpie::guarded([&] {
    kelpie::require_pointer("reckoning", reckoning);
    kelpie::require_pointer("x", x);
    kelpie::require_size("x", inputs, reckoning->inputs);
    const std::size_t states = reckoning->reckoning.states();
    reckoning->reckoning.update({x, inputs}, t,
                                {covariance, covariance == nullptr ? 0 : states * states});
  });
}

kelpie_status kelpie_reckoning_velocity(const kelpie_reckoning* reckoning, double* velocity,
                                        double* covariance, int32_t* faults, size_t states) {
  return kelpie::guarded([&] {
    kelpie::require_pointer("reckoning", reckoning);
    kelpie::require_pointer("velocity", velocity);
    const kelpie::DeadReckoning& from = reckoning->reckoning;
    kelpie::require_size("velocity", states, from.states());
    for (std::size_t i = 0; i < states; ++i) {
      velocity[i] = from.started() ? from.velocity(i) : std::nan("");
      if (faults != nullptr) {
        faults[i] = static_cast<std::int32_t>(from.fault(i));
      }
      for (std::size_t k = 0; covariance != nullptr && k < states; ++k) {
        covariance[i * states + k] = from.covariance(i, k);
      }
    }
  });
}

double kelpie_reckoning_silent_s(const kelpie_reckoning* reckoning) {
  return reckoning->reckoning.silent_s();
}

kelpie_status kelpie_reckoning_measured_heading(kelpie_reckoning* reckoning, double heading,
                                                double deviation) {
  return kelpie::guarded([&] {
    kelpie::require_pointer("reckoning", reckoning);
    reckoning->reckoning.measured_heading(heading, deviation);
  });
}

double kelpie_reckoning_heading(const kelpie_reckoning* reckoning) {
  return reckoning->reckoning.heading();
}

kelpie_status kelpie_reckoning_current(const kelpie_reckoning* reckoning, double* current) {
  return kelpie::guarded([&] {
    kelpie::require_pointer("reckoning", reckoning);
    kelpie::require_pointer("current", current);
    std::ranges::copy(reckoning->reckoning.current(), current);
  });
}

kelpie_status kelpie_reckoning_drift(const kelpie_reckoning* reckoning, double* position,
                                     double* covariance) {
  return kelpie::guarded([&] {
    kelpie::require_pointer("reckoning", reckoning);
    kelpie::require_pointer("position", position);
    const kelpie::Drift drift = reckoning->reckoning.drift();
    std::ranges::copy(drift.position_m, position);
    if (covariance != nullptr) {
      std::ranges::copy(drift.covariance_m2, covariance);
    }
  });
}

double kelpie_reckoning_step(const kelpie_reckoning* reckoning) {
  return reckoning->reckoning.step();
}

double kelpie_reckoning_noise_factor(const kelpie_reckoning* reckoning) {
  return reckoning->reckoning.noise_factor();
}

kelpie_status kelpie_reckoning_restate(kelpie_reckoning* reckoning, const double* x, size_t inputs,
                                       int32_t path) {
  return kelpie::guarded([&] {
    kelpie::require_pointer("reckoning", reckoning);
    kelpie::require_pointer("x", x);
    kelpie::require(path == KELPIE_COMMANDS_HELD || path == KELPIE_COMMANDS_LINEAR, "path",
                    "has to be KELPIE_COMMANDS_HELD or KELPIE_COMMANDS_LINEAR");
    reckoning->reckoning.restate({x, inputs}, static_cast<kelpie::CommandPath>(path));
  });
}
