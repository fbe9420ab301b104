// SPDX-License-Identifier: Apache-2.0
// 05, first part: a ROS 2 bag without ROS. Records four minutes of the toy vehicle as MCAP. An
// autopilot without ROS could do the same; `ros2 bag` reads the file as well.
//
//   05_record_bag FILE.mcap

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <iostream>
#include <span>
#include <vector>

#include "bag/mcap_writer.hpp"
#include "file/atomic_file.hpp"
#include "kelpie/core/random.hpp"
#include "toy_vehicle.hpp"

namespace {

constexpr const char* kTwist =
    "Vector3 linear\nVector3 angular\n"
    "================================================================================\n"
    "MSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n";

// A message that contains only numbers, as CDR: four bytes for the byte order, then the numbers.
std::vector<std::byte> cdr(std::span<const double> values) {
  constexpr bool kLittle = std::endian::native == std::endian::little;
  std::vector<std::byte> data(4 + values.size_bytes());
  data[1] = std::byte{kLittle ? 1 : 0};
  std::memcpy(data.data() + 4, values.data(), values.size_bytes());
  return data;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: 05_record_bag FILE.mcap\n";
    return 2;
  }
  kelpie::bag::McapWriter bag;
  bag.add_topic({.name = "/velocity", .type = "geometry_msgs/msg/Twist", .definition = kTwist});
  bag.add_topic({.name = "/thrusters",
                 .type = "toy_msgs/msg/Thrusters",
                 .definition = "float64[2] speed  # rev/s\n"});
  ToyVehicle vehicle;
  kelpie::RandomStream noise(1, "velocity log");
  for (std::uint32_t i = 0; i < 2400; ++i) {
    const auto [n1, n2] = ToyVehicle::pilot(vehicle.t());
    const auto now_ns = static_cast<std::int64_t>(vehicle.t() * 1e9);
    const auto write = [&](std::size_t topic, std::span<const double> values) {
      const std::vector<std::byte> data = cdr(values);
      bag.write({.topic = topic,
                 .receive_ns = now_ns,
                 .publish_ns = now_ns,
                 .sequence = i,
                 .data = data});
    };
    write(0, std::array{vehicle.u() + 0.002 * noise.normal(), 0.0, 0.0, 0.0, 0.0,
                        vehicle.r() + 0.002 * noise.normal()});
    write(1, std::array{n1, n2});
    vehicle.drive(n1, n2);
  }
  kelpie::file::write_file_whole(argv[1], bag.finish());
}
