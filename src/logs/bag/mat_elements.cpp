// SPDX-License-Identifier: Apache-2.0
#include "bag/mat_elements.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "bag/byte_reader.hpp"
#include "bag/compression.hpp"
#include "bag/tuning.hpp"

namespace kelpie::bag {
namespace {

constexpr std::size_t kMatHead = 128;
constexpr std::size_t kTag = 8;

// Kinds of elements.
constexpr std::uint32_t kMatrix = 14;
constexpr std::uint32_t kCompressed = 15;

// Classes of matrices.
constexpr std::uint32_t kCell = 1;
constexpr std::uint32_t kStruct = 2;
constexpr std::uint32_t kObject = 3;
constexpr std::uint32_t kCharacters = 4;
constexpr std::uint32_t kFirstNumeric = 6;
constexpr std::uint32_t kLastNumeric = 15;

// How many bytes a number of this kind of element takes; 0: it is none.
std::size_t number_bytes(std::uint32_t kind) {
  constexpr std::array<std::uint8_t, 19> kBytes{0, 1, 1, 2, 2, 4, 4, 4, 0, 8,
                                                0, 0, 8, 8, 0, 0, 1, 2, 4};
  return kind < kBytes.size() ? kBytes[kind] : 0;
}

struct MatElement {
  std::uint32_t kind = 0;
  std::span<const std::byte> data;
};

// Takes elements one after the other.
class MatElements {
 public:
  MatElements(std::span<const std::byte> bytes, std::endian order) : left_(bytes), order_(order) {}

  std::uint32_t word(std::span<const std::byte> bytes, std::size_t at) const {
    return number_at<std::uint32_t>(bytes.subspan(at), order_);
  }
  std::size_t left() const { return left_.size(); }

  MatElement next() {
    if (left_.size() < kTag) {
      throw InputError(fmt::format("{} bytes where an element is due", left_.size()));
    }
    const std::uint32_t first = word(left_, 0);
    const bool is_small = first >> 16U != 0;  // its data stand within its tag
    const std::uint64_t bytes = is_small ? first >> 16U : word(left_, 4);
    const std::size_t head = is_small ? 4 : kTag;
    if (bytes > (is_small ? 4 : left_.size() - kTag)) {
      throw InputError(fmt::format("an element of {} bytes, {} are left", bytes, left_.size()));
    }
    const MatElement element{.kind = is_small ? first & 0xFFFFU : first,
                             .data = left_.subspan(head, static_cast<std::size_t>(bytes))};
    // All begin at multiples of 8 but what is compressed.
    const std::size_t padded =
        element.kind == kCompressed ? head + bytes : (head + bytes + 7) / 8 * 8;
    left_ = left_.subspan(std::min(left_.size(), padded));
    return element;
  }

 private:
  std::span<const std::byte> left_;
  std::endian order_;
};

// Throws InputError where a matrix isn't what its sizes say.
void check_matrix(std::span<const std::byte> bytes, std::endian order, std::size_t depth) {
  if (bytes.empty()) {
    return;  // an empty one within a struct or cell array
  }
  if (depth > kTuning.deepest_struct) {
    throw InputError("structs within structs more than 16 deep");
  }
  MatElements parts(bytes, order);
  const MatElement flags = parts.next();
  const MatElement sizes = parts.next();
  parts.next();  // the name
  if (flags.data.size() < 8 || sizes.data.size() < 8 || sizes.data.size() % 4 != 0) {
    throw InputError("a variable without class or size");
  }
  const std::uint32_t kind = parts.word(flags.data, 0) & 0xFFU;
  std::uint64_t count = 1;
  for (std::size_t at = 0; at < sizes.data.size(); at += 4) {
    const std::uint64_t size = parts.word(sizes.data, at);
    if (size != 0 && count > kTuning.most_numbers / size) {
      throw InputError("an impossible size");
    }
    count *= size;
  }
  std::uint64_t held = kind == kCell ? count : 0;
  if (kind == kStruct || kind == kObject) {
    if (kind == kObject) {
      parts.next();  // the name of its class
    }
    const MatElement length = parts.next();
    const MatElement names = parts.next();
    const std::uint32_t bytes_each = length.data.size() < 4 ? 0 : parts.word(length.data, 0);
    if (bytes_each == 0 || names.data.size() % bytes_each != 0) {
      throw InputError("a struct without names of fields");
    }
    const std::size_t fields = names.data.size() / bytes_each;
    held = fields > 0 && count > UINT64_MAX / fields ? UINT64_MAX : count * fields;
  }
  if (held > parts.left() / kTag) {
    throw InputError(fmt::format("{} elements, which {} bytes can't hold", held, parts.left()));
  }
  for (; held > 0; --held) {
    const MatElement inner = parts.next();
    if (inner.kind != kMatrix) {
      throw InputError(fmt::format("an element of the kind {} where a matrix is due", inner.kind));
    }
    check_matrix(inner.data, order, depth + 1);
  }
  const bool has_numbers = kind == kCharacters || (kind >= kFirstNumeric && kind <= kLastNumeric);
  if (has_numbers && count > 0) {
    const MatElement numbers = parts.next();
    const std::size_t each = number_bytes(numbers.kind);
    if (each == 0 || numbers.data.size() / each < count) {
      throw InputError(
          fmt::format("{} numbers, which {} bytes can't hold", count, numbers.data.size()));
    }
  }
}

// What compressed content unpacks to: an element, whose tag tells how much.
std::vector<std::byte> inflated(std::span<const std::byte> packed, std::endian order) {
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) {
    throw Failure("zlib: out of memory");
  }
  std::vector<std::byte> unpacked(kTag);
  // NOLINTBEGIN: C
  stream.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  stream.next_out = reinterpret_cast<Bytef*>(unpacked.data());
  stream.avail_out = static_cast<uInt>(kTag);
  int state = inflate(&stream, Z_NO_FLUSH);
  std::uint64_t bytes = 0;
  if (stream.avail_out == 0) {
    bytes = number_at<std::uint32_t>(std::span(unpacked).subspan(4), order);
    if (is_believable(bytes, packed.size())) {
      unpacked.resize(static_cast<std::size_t>(kTag + bytes));
      stream.next_out = reinterpret_cast<Bytef*>(unpacked.data() + kTag);
      stream.avail_out = static_cast<uInt>(bytes);
      state = inflate(&stream, Z_FINISH);
    }
  }
  // NOLINTEND
  inflateEnd(&stream);
  if (state != Z_STREAM_END || stream.avail_out != 0) {
    throw InputError("compressed content that is damaged");
  }
  return unpacked;
}

void check_variable(const MatElement& element, std::endian order) {
  if (element.kind == kMatrix) {
    check_matrix(element.data, order, 0);
  } else if (element.kind == kCompressed) {
    const std::vector<std::byte> unpacked = inflated(element.data, order);
    const MatElement inner = MatElements(unpacked, order).next();
    if (inner.kind != kMatrix) {
      throw InputError(fmt::format("compressed content of the kind {}", inner.kind));
    }
    check_matrix(inner.data, order, 0);
  } else {
    throw InputError(fmt::format("an element of the kind {}", element.kind));
  }
}

}  // namespace

std::size_t sound_mat_variables(std::span<const std::byte> bytes, const std::string& file,
                                const std::function<void(const InputError&)>& lose) {
  const std::endian order =
      bytes[kMatHead - 2] == std::byte{'I'} ? std::endian::little : std::endian::big;
  std::size_t count = 0;
  MatElements elements(bytes.subspan(kMatHead), order);
  while (elements.left() > 0) {
    const std::uint64_t offset = bytes.size() - elements.left();
    try {
      check_variable(elements.next(), order);
    } catch (const InputError& error) {
      lose(InputError({.file = file, .field = fmt::format("offset {}", offset)},
                      fmt::format("is cut off or damaged: the variable that begins here has {}",
                                  error.what())));
      break;
    }
    ++count;
  }
  return count;
}

}  // namespace kelpie::bag
