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
/// so that saving and loading can't drift apart. The loading object is made with the arguments of
/// the saved object; values that follow from the arguments are not in the archive. Saving writes to
/// the archive only, so that others may read the object meanwhile, and rejects numbers that aren't
/// finite, as loading does. Loading checks every number and length before use, and throws
/// InputError naming the faulty part; the object may only be destroyed then.
class Archive {
 public:
  Archive() = default;  ///< Saves.
  /// Loads from `bytes`; keeps a reference to the bytes.
  explicit Archive(std::string_view bytes) : left_(bytes), loading_(true) {}

  /// No bound but the bytes left.
  static constexpr std::size_t kAnyLength = std::numeric_limits<std::size_t>::max();

  bool loading() const { return loading_; }
  const std::string& bytes() const { return bytes_; }  ///< The saved bytes.

  void number(double& value);              ///< Finite.
  void numbers(std::span<double> values);  ///< Finite.
  void numbers(std::span<float> values);   ///< Finite.
  void any_number(double& value);          ///< May also be infinite or NaN.
  void flag(bool& value);                  ///< True or false.
  void text(std::string& value);           ///< Up to 1 MiB.

  /// A whole number, by default within half the range of a counter.
  template <std::integral T>
  void whole(T& value, std::type_identity_t<T> least = 0, std::type_identity_t<T> most = kMost<T>) {
    auto wide = static_cast<std::int64_t>(value);  // NOLINT(bugprone-signed-char-misuse)
    whole_number(wide, static_cast<std::int64_t>(least), static_cast<std::int64_t>(most));
    if (loading_) {
      value = static_cast<T>(wide);
    }
  }

  /// One of the values of an enumeration, from `first` to `last`.
  template <typename Enum>
    requires std::is_enum_v<Enum>
  void choice(Enum& value, Enum first, Enum last) {
    auto place = static_cast<int>(value);
    whole(place, static_cast<int>(first), static_cast<int>(last));
    if (loading_) {
      value = static_cast<Enum>(place);
    }
  }

  /// The length of a following list, bounded by `most` and by the bytes left, with `item_bytes` or
  /// more per item.
  void length(std::size_t& size, std::size_t most, std::size_t item_bytes = 8);

  /// A vector of at most `most` items, with `visit(item)` for each item. Allocates beyond the
  /// capacity of the vector only.
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

  /// A value equal on both sides; otherwise InputError with both values.
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

  /// To be called last; throws InputError on unused bytes.
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
