// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <utility>

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

}  // namespace kelpie::dds
