// SPDX-License-Identifier: Apache-2.0
#include "kelpie/motion/frame.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/text.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie {
namespace {

bool is_of_vehicle(Frame frame) {
  return frame == Frame::flu || frame == Frame::frd;
}

// In the order of Frame.
const std::array<std::string, 4>& frames() {
  static const std::array<std::string, 4> kNames{"FLU", "FRD", "ENU", "NED"};
  return kNames;
}

}  // namespace

Frame frame_from(const std::string& name) {
  const auto* const found = std::ranges::find(frames(), name);
  if (found == frames().end()) {
    throw InputError("'" + name + "' is no frame" + did_you_mean(name, frames()) +
                     "; frames are FLU and FRD (vehicle), ENU and NED (world)");
  }
  return static_cast<Frame>(found - frames().begin());
}

std::string frame_name(Frame frame) {
  return frames().at(static_cast<std::size_t>(frame));
}

Triple converted(const Triple& vector, Frame from, Frame to) {
  if (is_of_vehicle(from) != is_of_vehicle(to)) {
    throw InputError(
        "one frame is the vehicle's, the other the world's; between them lies the attitude, which "
        "the vector needs then");
  }
  if (from == to) {
    return vector;
  }
  const auto& [x, y, z] = vector;
  return is_of_vehicle(from) ? Triple{x, -y, -z} : Triple{y, x, -z};
}

Triple in_body(const Triple& vector, const Triple& angles) {
  const auto turned = [](double& a, double& b, double angle) {
    const double before = a;
    a = std::cos(angle) * before + std::sin(angle) * b;
    b = std::cos(angle) * b - std::sin(angle) * before;
  };
  auto [x, y, z] = vector;
  turned(x, y, angles[2]);
  turned(z, x, angles[1]);
  turned(y, z, angles[0]);
  return {x, y, z};
}

Triple in_body(const Triple& vector, const std::array<double, 4>& quaternion) {
  const auto& [w, i, j, k] = quaternion;
  const auto& [x, y, z] = vector;
  const double square = w * w + i * i + j * j + k * k;
  if (!(square > 0.0)) {
    const double none = std::numeric_limits<double>::quiet_NaN();
    return {none, none, none};
  }
  // The rows of the transposed rotation matrix.
  return {((w * w + i * i - j * j - k * k) * x + 2.0 * (i * j + w * k) * y +
           2.0 * (i * k - w * j) * z) /
              square,
          (2.0 * (i * j - w * k) * x + (w * w - i * i + j * j - k * k) * y +
           2.0 * (j * k + w * i) * z) /
              square,
          (2.0 * (i * k + w * j) * x + 2.0 * (j * k - w * i) * y +
           (w * w - i * i - j * j + k * k) * z) /
              square};
}

Triple without_lever_arm(const Triple& velocity, const Triple& rates, const Triple& arm_m) {
  const auto& [p, q, r] = rates;
  const auto& [x, y, z] = arm_m;
  return {velocity[0] - (q * z - r * y), velocity[1] - (r * x - p * z),
          velocity[2] - (p * y - q * x)};
}

}  // namespace kelpie
