// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "dds/network.hpp"
#include "dds/quality.hpp"

namespace kelpie::dds {

/// Owns an object of Cyclone DDS, with its children, by number.
class Entity {
 public:
  Entity() = default;
  /// Takes over the result of a dds_create_… function. Throws Failure, starting with `what`, on an
  /// error code.
  Entity(std::int32_t created, const std::string& what);
  ~Entity();
  Entity(const Entity&) = delete;
  Entity& operator=(const Entity&) = delete;
  Entity(Entity&& other) noexcept : number_(std::exchange(other.number_, 0)) {}
  Entity& operator=(Entity&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }

  std::int32_t number() const { return number_; }

 private:
  std::int32_t number_ = 0;  // 0: none
};

/// A present publisher or subscriber in the domain.
struct Endpoint {
  bool publishes = false;
  bool own = false;      ///< of this process
  std::string topic;     ///< "/odom"
  std::string type;      ///< "nav_msgs/msg/Odometry"
  Quality quality;       ///< offered or requested
  std::uint64_t id = 0;  ///< number in Cyclone DDS
};

/// This process's participant in a DDS domain. Network alone determines its connections. For any
/// threads.
class Participant {
 public:
  /// Opens sockets and starts the library's threads. Throws InputError on an invalid `network`,
  /// Failure with the library's message: unknown interface, no free port, a second participant of a
  /// domain in this process.
  explicit Participant(const Network& network);
  ~Participant();
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;

  /// Endpoints of a topic of ROS 2 ("/odom") discovered so far. Discovery takes some hundred
  /// milliseconds. Cost: of the endpoints that came and went since the last call, and of the
  /// result.
  std::vector<Endpoint> endpoints(const std::string& topic) const;

  /// Topics with a publisher in another process, in alphabetical order.
  std::vector<std::string> published() const;

  /// Grows with every endpoint that comes, changes or goes.
  std::uint64_t revision() const;

  /// Packets that could not be read, in all domains of this process.
  static std::uint64_t damaged();

  std::int32_t number() const { return participant_.number(); }  ///< Parent of readers and writers.

 private:
  class Directory;

  Entity domain_;
  Entity participant_;
  std::unique_ptr<Directory> directory_;
};

}  // namespace kelpie::dds
