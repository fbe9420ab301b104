// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace kelpie {

/// The state of an object as bytes: little-endian, every number in eight bytes (floats in four), no
/// names. A class has one function for both ways,
///
///     void visit(Archive& archive) {
///       archive.number(mean_);
///       archive.part("buffer", buffer_);
///     }
///
/// so that what is saved and what is loaded can't drift apart. An object that loads has been made
/// with the same arguments as the one that was saved; what follows from these isn't in the archive.
/// Saving writes to nothing but the archive, and refuses what loading would: a number not finite.
/// Loading checks every number and length before it is used, and throws InputError naming the part
/// on what doesn't fit; the object may only be destroyed then.
class Archive {
 public:
  Archive() = default;  ///< Saves.
  /// Loads from `bytes`, which have to outlive it.
  explicit Archive(std::string_view bytes) : left_(bytes), loading_(true) {}

  /// Where the bytes that are left are bound enough.
  static constexpr std::size_t kAnyLength = std::numeric_limits<std::size_t>::max();

  bool loading() const { return loading_; }
  const std::string& bytes() const { return bytes_; }  ///< what was saved

  void number(double& value);              ///< Has to be finite.
  void numbers(std::span<double> values);  ///< Have to be finite.
  void numbers(std::span<float> values);   ///< Have to be finite.
  void any_number(double& value);          ///< May also be infinite or NaN.
  void flag(bool& value);                  ///< True or false.
  void text(std::string& value);           ///< Of any length.

  /// A whole number, by default one that a counter can hold and go on counting.
  template <std::integral T>
  void whole(T& value, std::type_identity_t<T> least = 0, std::type_identity_t<T> most = kMost<T>) {
    auto wide = static_cast<std::int64_t>(value);
    whole_number(wide, static_cast<std::int64_t>(least), static_cast<std::int64_t>(most));
    if (loading_) {
      value = static_cast<T>(wide);
    }
  }

  /// The length of what follows; `most` and the bytes that are left bound it, each item taking
  /// `item_bytes` or more.
  void length(std::size_t& size, std::size_t most, std::size_t item_bytes = 8);

  /// A vector within `most` items, each put through `visit(item)`. Doesn't allocate where the
  /// vector has the capacity.
  template <typename T, typename Visit>
  void list(std::vector<T>& items, std::size_t most, Visit visit, std::size_t item_bytes = 8) {
    std::size_t size = items.size();
    length(size, most, item_bytes);
    if (loading_) {
      items.resize(size);
    }
    for (T& item : items) {
      visit(item);
    }
  }

  /// What both sides have to agree on, or InputError with the two values.
  void same(std::string_view field, const std::string& here);

  /// A part of the object, by its own visit(archive, arguments...).
  template <typename Part, typename... Arguments>
  void part(std::string_view name, Part& object, const Arguments&... arguments) {
    path_.emplace_back(name);
    object.visit(*this, arguments...);
    path_.pop_back();
  }

  /// Throws InputError, naming the part at hand, unless `good`.
  void require(bool good, std::string_view otherwise) const;

  /// To be called last: all bytes have to be used up.
  void finish() const { require(left_.empty(), "more bytes than the state has"); }

 private:
  template <typename T>
  static constexpr T kMost = static_cast<T>(
      sizeof(T) < sizeof(std::int64_t) ? std::numeric_limits<T>::max() / 2 : std::int64_t{1} << 53);

  void whole_number(std::int64_t& value, std::int64_t least, std::int64_t most);
  char* put(std::size_t size);
  const char* take(std::size_t size);
  template <typename Number>
  void all(std::span<Number> values, bool finite);

  std::string bytes_;
  std::string_view left_;
  std::vector<std::string> path_;
  bool loading_ = false;
};

}  // namespace kelpie
