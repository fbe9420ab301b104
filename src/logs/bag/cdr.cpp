// SPDX-License-Identifier: Apache-2.0
#include "bag/cdr.hpp"

#include <fmt/format.h>

#include <vector>

#include "bag/byte_reader.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie::bag {
namespace {

constexpr std::size_t kEncapsulation = 4;
// Writers pad to four bytes, some to eight.
constexpr std::size_t kMostPadding = 7;

class Walker {
 public:
  Walker(const MessageType& type, std::span<const std::byte> message, NumberVisitor& visitor)
      : type_(type), message_(message), visitor_(visitor) {}

  void walk_cdr() {
    read_encapsulation();
    is_aligned_ = true;
    walk(kMostPadding);
  }

  void walk(std::size_t most_padding = 0) {
    structure(type_.root);
    if (const std::size_t left = message_.size() - at_; left > most_padding) {
      refuse_cdr(type_.name,
                 fmt::format("{} bytes are left over after the last field; the definition "
                             "isn't that of the message",
                             left));
    }
  }

 private:
  [[noreturn]] void refuse_cdr(const std::string& field, const std::string& message) const {
    throw InputError(fmt::format("byte {}, {}", at_, field), message);
  }

  void read_encapsulation() {
    require(type_.name, kEncapsulation);
    const auto kind = number_at<std::uint16_t>(message_, std::endian::big);
    if (kind > 1) {
      refuse_cdr(type_.name,
                 fmt::format("its encoding has the number {}; only plain CDR, 0 and 1, is "
                             "read",
                             kind));
    }
    order_ = kind == 0 ? std::endian::big : std::endian::little;
    at_ = kEncapsulation;
  }

  // Alignment counts from behind the encapsulation.
  void align(std::size_t bytes) {
    if (!is_aligned_) {
      return;
    }
    const std::size_t position = at_ - kEncapsulation;
    at_ = std::min(message_.size(), at_ + (bytes - position % bytes) % bytes);
  }

  void require(const std::string& field, std::uint64_t bytes) const {
    if (const std::uint64_t left = message_.size() - at_; bytes > left) {
      refuse_cdr(field,
                 fmt::format("the message is too short: {} bytes are due at least, {} are left",
                             bytes, left));
    }
  }

  std::uint32_t length(const Field& field) {
    align(sizeof(std::uint32_t));
    require(field.name, sizeof(std::uint32_t));
    const auto value = number_at<std::uint32_t>(message_.subspan(at_), order_);
    at_ += sizeof(std::uint32_t);
    return value;
  }

  void structure(const Field& field) {
    if (field.fields.empty() && is_aligned_) {
      require(field.name, 1);
      ++at_;
    }
    for (const Field& part : field.fields) {
      if (part.shape == FieldShape::single) {
        element(part);
      } else {
        elements(part);
      }
    }
  }

  void elements(const Field& field) {
    const bool is_sequence = field.shape == FieldShape::sequence;
    const std::uint32_t count = is_sequence ? length(field) : field.size;
    if (is_sequence && count > field.size) {
      refuse_cdr(field.name, fmt::format("has {} elements; its type allows {}", count, field.size));
    }
    if (count == 0 || field.least_bytes == 0) {
      return;  // structures without members may be ever so many
    }
    require(field.name, count * field.least_bytes);
    if (is_number(field.kind) && !visitor_.wants(field.leaf)) {
      align(bytes_of(field.kind));
      require(field.name, count * field.least_bytes);
      at_ += static_cast<std::size_t>(count * field.least_bytes);
      return;
    }
    indices_.push_back(0);
    for (std::uint32_t i = 0; i < count; ++i) {
      indices_.back() = i;
      element(field);
    }
    indices_.pop_back();
  }

  void element(const Field& field) {
    if (field.kind == FieldKind::structure) {
      structure(field);
    } else if (field.kind == FieldKind::string) {
      text(field);
    } else if (field.kind == FieldKind::characters) {
      require(field.name, field.size);
      at_ += field.size;
    } else {
      number(field);
    }
  }

  void number(const Field& field) {
    const std::size_t bytes = bytes_of(field.kind);
    align(bytes);
    require(field.name, bytes);
    if (visitor_.wants(field.leaf)) {
      visitor_.number(
          field.leaf, indices_,
          type_.leaves[field.leaf].factor * number_of(field.kind, message_.subspan(at_), order_));
    }
    at_ += bytes;
  }

  void text(const Field& field) {
    const std::uint32_t bytes = length(field);  // with the closing NUL
    if (field.string_bound < Field::kUnbounded && bytes > field.string_bound + 1) {
      refuse_cdr(field.name,
                 fmt::format("has {} bytes; its type allows {}", bytes - 1, field.string_bound));
    }
    require(field.name, bytes);
    at_ += bytes;
  }

  const MessageType& type_;
  std::span<const std::byte> message_;
  NumberVisitor& visitor_;
  std::endian order_ = std::endian::little;
  bool is_aligned_ = false;
  std::size_t at_ = 0;
  std::vector<std::uint32_t> indices_;
};

}  // namespace

void visit_numbers(const MessageType& type, std::span<const std::byte> message,
                   NumberVisitor& visitor) {
  Walker(type, message, visitor).walk_cdr();
}

void visit_packed_numbers(const MessageType& type, std::span<const std::byte> message,
                          NumberVisitor& visitor) {
  Walker(type, message, visitor).walk();
}

}  // namespace kelpie::bag
