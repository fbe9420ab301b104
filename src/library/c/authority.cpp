// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "c/guarded.hpp"
#include "c/handle.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/vehicle/diagnosis.hpp"

struct kelpie_authority {
  kelpie::Authority authority;
  std::string text;
};

namespace kelpie {
namespace {

std::size_t place_of(const kelpie_model& model, const char* name) {
  require_pointer("thrusters", name);
  const auto found = std::ranges::find(model.inputs, name);
  require(found != model.inputs.end(), "thrusters", std::string("'") + name + "' is no input");
  return static_cast<std::size_t>(found - model.inputs.begin());
}

}  // namespace
}  // namespace kelpie

kelpie_status kelpie_authority_create(const kelpie_model* model, const char* const* thrusters,
                                      const double* least, const double* most, size_t count,
                                      kelpie_authority** authority) {
  return kelpie::guarded([&] {
    kelpie::require_pointer("model", model);
    kelpie::require_pointer("thrusters", thrusters);
    kelpie::require_pointer("least", least);
    kelpie::require_pointer("most", most);
    kelpie::require_pointer("authority", authority);
    const kelpie::Diagnosis* const diagnosis = model->model().diagnosis();
    if (diagnosis == nullptr) {
      throw kelpie::InputError("model", "doesn't know its velocities (states)");
    }
    std::vector<kelpie::CommandRange> ranges;
    for (std::size_t i = 0; i < count; ++i) {
      ranges.push_back({kelpie::place_of(*model, thrusters[i]), least[i], most[i]});
    }
    auto made = std::make_unique<kelpie_authority>(
        kelpie_authority{kelpie::Authority(*diagnosis, ranges), {}});
    made->text = made->authority.text({model->inputs, model->targets});
    *authority = made.release();
  });
}

void kelpie_authority_free(kelpie_authority* authority) {
  delete authority;  // NOLINT(cppcoreguidelines-owning-memory): C owns it
}

const char* kelpie_authority_text(const kelpie_authority* authority) {
  return authority->text.c_str();
}

kelpie_status kelpie_authority_axis(const kelpie_authority* authority, size_t axis,
                                    kelpie_axis_authority* values) {
  return kelpie::guarded([&] {
    kelpie::require_pointer("authority", authority);
    kelpie::require_pointer("values", values);
    const auto& axes = authority->authority.axes();
    kelpie::require(axis < axes.size(), "axis", "is beyond the targets of the model");
    *values = {.most = axes[axis].most,
               .least = axes[axis].least,
               .nominal_most = axes[axis].nominal_most,
               .nominal_least = axes[axis].nominal_least,
               .alone_most = axes[axis].alone_most,
               .alone_least = axes[axis].alone_least,
               .left = axes[axis].left()};
  });
}

kelpie_status kelpie_authority_allocate(const kelpie_authority* authority, const double* wanted,
                                        size_t targets, double* commands, size_t count,
                                        double* missing) {
  return kelpie::guarded([&] {
    kelpie::require_pointer("authority", authority);
    kelpie::require_pointer("wanted", wanted);
    kelpie::require_pointer("commands", commands);
    kelpie::require_size("commands", count, authority->authority.thrusters().size());
    const kelpie::Allocation allocation = authority->authority.allocate({wanted, targets});
    std::ranges::copy(allocation.commands, commands);
    if (missing != nullptr) {
      *missing = allocation.missing;
    }
  });
}

kelpie_status kelpie_authority_thruster(const kelpie_authority* authority, size_t thruster,
                                        size_t axis, kelpie_thruster_effect* effect) {
  return kelpie::guarded([&] {
    kelpie::require_pointer("authority", authority);
    kelpie::require_pointer("effect", effect);
    const kelpie::Authority& from = authority->authority;
    kelpie::require(thruster < from.thrusters().size(), "thruster", "is beyond the last");
    kelpie::require(axis < from.axes().size(), "axis", "is beyond the targets of the model");
    const kelpie::ThrusterEffect& one = from.thrusters()[thruster];
    *effect = {.ahead = one.ahead[axis],
               .astern = one.astern[axis],
               .ahead_width = one.ahead_width[axis],
               .astern_width = one.astern_width[axis],
               .nominal_ahead = one.nominal_ahead[axis],
               .nominal_astern = one.nominal_astern[axis],
               .share = one.share};
  });
}

kelpie_status kelpie_authority_singular_value(const kelpie_authority* authority, size_t i,
                                              double* value, double* nominal) {
  return kelpie::guarded([&] {
    kelpie::require_pointer("authority", authority);
    kelpie::require_pointer("value", value);
    const kelpie::Authority& from = authority->authority;
    kelpie::require(i < from.singular_values().size(), "i", "is beyond the last singular value");
    *value = from.singular_values()[i];
    if (nominal != nullptr) {
      *nominal = from.nominal_singular_values()[i];
    }
  });
}
