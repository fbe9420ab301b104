// SPDX-License-Identifier: Apache-2.0
#include "mavlink/frame_writer.hpp"

#include <algorithm>
#include <string>

#include "kelpie/core/error.hpp"
#include "mavlink/checksum.hpp"

namespace kelpie::mavlink {
namespace {

const Field& field_of(const Definition& definition, std::string_view name) {
  const Field* const field = definition.find(name);
  if (field == nullptr) {
    throw InputError(name, "is no field of " + definition.name);
  }
  return *field;
}

}  // namespace

FrameWriter& FrameWriter::begin(std::string_view name) {
  definition_ = find_definition(name);
  if (definition_ == nullptr) {
    throw InputError(name, "is an unknown message");
  }
  payload_.assign(definition_->all_bytes, std::byte{0});
  return *this;
}

FrameWriter& FrameWriter::set(std::string_view name, double value, std::size_t index) {
  const Field& field = field_of(*definition_, name);
  require(index < field.count && is_number(field.kind), name,
          "has no such number in " + definition_->name);
  require(wire::holds(field.kind, value), name,
          std::to_string(value) + " is not an integer within range");
  wire::store_number(std::span(payload_).subspan(field.offset + index * bytes_of(field.kind)),
                     field.kind, value);
  return *this;
}

FrameWriter& FrameWriter::set(std::string_view name, std::string_view text) {
  const Field& field = field_of(*definition_, name);
  require(field.kind == FieldKind::characters, name, "is no text in " + definition_->name);
  const auto place = std::span(payload_).subspan(field.offset, field.count);
  std::ranges::fill(place, std::byte{0});
  std::ranges::copy(std::as_bytes(std::span(text.substr(0, field.count))), place.begin());
  return *this;
}

std::span<const std::byte> FrameWriter::finish() {
  std::size_t length = payload_.size();
  while (length > 1 && payload_[length - 1] == std::byte{0}) {
    --length;
  }
  frame_ = {std::byte{0xFD},
            static_cast<std::byte>(length),
            static_cast<std::byte>(signer_ ? 1 : 0),  // MAVLINK_IFLAG_SIGNED
            std::byte{0},
            static_cast<std::byte>(sequence_++),
            static_cast<std::byte>(system_),
            static_cast<std::byte>(component_),
            static_cast<std::byte>(definition_->id & 0xFFU),
            static_cast<std::byte>(definition_->id >> 8U & 0xFFU),
            static_cast<std::byte>(definition_->id >> 16U)};
  frame_.insert(frame_.end(), payload_.begin(),
                payload_.begin() + static_cast<std::ptrdiff_t>(length));
  const auto extra = static_cast<std::byte>(definition_->crc_extra);
  const std::uint16_t crc = checksum(std::span(&extra, 1), checksum(std::span(frame_).subspan(1)));
  frame_.push_back(static_cast<std::byte>(crc & 0xFFU));
  frame_.push_back(static_cast<std::byte>(crc >> 8U));
  if (signer_) {
    signer_(frame_);
  }
  return frame_;
}

}  // namespace kelpie::mavlink
