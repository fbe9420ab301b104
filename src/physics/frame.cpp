// SPDX-License-Identifier: Apache-2.0
#include "kelpie/physics/frame.hpp"

#include <algorithm>

#include "kelpie/core/error.hpp"
#include "kelpie/core/text.hpp"

namespace kelpie {
namespace {

bool is_of_vehicle(Frame frame) {
  return frame == Frame::flu || frame == Frame::frd;
}

}  // namespace

Frame frame_from(const std::string& name) {
  const std::array<std::string, 4> names{"FLU", "FRD", "ENU", "NED"};
  const auto* const found = std::ranges::find(names, name);
  if (found == names.end()) {
    throw InputError("'" + name + "' is no frame" + did_you_mean(name, names) +
                     "; frames are FLU and FRD (vehicle), ENU and NED (world)");
  }
  return static_cast<Frame>(found - names.begin());
}

Triple converted(const Triple& vector, Frame from, Frame to) {
  if (is_of_vehicle(from) != is_of_vehicle(to)) {
    throw InputError(
        "one frame is the vehicle's, the other the world's; between them lies the attitude, which "
        "isn't undone");
  }
  if (from == to) {
    return vector;
  }
  const auto& [x, y, z] = vector;
  return is_of_vehicle(from) ? Triple{x, -y, -z} : Triple{y, x, -z};
}

Triple without_lever_arm(const Triple& velocity, const Triple& rates, const Triple& arm_m) {
  const auto& [p, q, r] = rates;
  const auto& [x, y, z] = arm_m;
  return {velocity[0] - (q * z - r * y), velocity[1] - (r * x - p * z),
          velocity[2] - (p * y - q * x)};
}

}  // namespace kelpie
