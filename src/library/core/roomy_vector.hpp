// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace kelpie {

/// A vector whose copies keep its capacity, which those of a std::vector need not: the copy of an
/// object that allocates in its constructor only has the same room.
template <typename T>
class RoomyVector : public std::vector<T> {
 public:
  RoomyVector() = default;
  ~RoomyVector() = default;
  RoomyVector(const RoomyVector& other) : std::vector<T>() { *this = other; }
  RoomyVector(RoomyVector&& other) noexcept = default;
  RoomyVector& operator=(const RoomyVector& other) {
    this->reserve(other.capacity());
    std::vector<T>::operator=(other);
    return *this;
  }
  RoomyVector& operator=(RoomyVector&& other) noexcept = default;
};

}  // namespace kelpie
