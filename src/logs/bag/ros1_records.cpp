// SPDX-License-Identifier: Apache-2.0
#include "bag/ros1_records.hpp"
#include "bag/tuning.hpp"

#include <fmt/format.h>

#include <bit>

namespace kelpie::bag {
namespace {

constexpr std::size_t kLength = sizeof(std::uint32_t);

std::uint32_t length_at(std::span<const std::byte> bytes) {
  return number_at<std::uint32_t>(bytes, std::endian::little);
}

// The first field of `bytes`, which loses it; none where no field begins.
std::optional<std::string_view> take_field(std::span<const std::byte>& bytes) {
  if (bytes.size() < kLength || length_at(bytes) > bytes.size() - kLength) {
    return std::nullopt;
  }
  const std::string_view field = text_of(bytes.subspan(kLength, length_at(bytes)));
  bytes = bytes.subspan(kLength + field.size());
  return field.find('=') == std::string_view::npos ? std::nullopt : std::optional(field);
}

// Whether a whole record begins here, whose kind and fields can be.
bool begins_record(std::span<const std::byte> bytes) {
  if (bytes.size() < 2 * kLength) {
    return false;
  }
  const std::uint32_t header = length_at(bytes);
  if (header == 0 || header > kTuning.longest_header || header > bytes.size() - 2 * kLength) {
    return false;
  }
  const std::span<const std::byte> fields = bytes.subspan(kLength, header);
  if (!Ros1Fields::are(fields) ||
      length_at(bytes.subspan(kLength + header)) > bytes.size() - 2 * kLength - header) {
    return false;
  }
  const Region nowhere;
  const auto op = Ros1Fields(fields, nowhere, 0).find("op");
  return op && op->size() == 1 && op->front() >= static_cast<char>(Ros1Op::message) &&
         op->front() <= static_cast<char>(Ros1Op::connection);
}

Ros1Record record_at(std::span<const std::byte> bytes, std::uint64_t at, const Region& region) {
  ByteReader reader(bytes.subspan(static_cast<std::size_t>(at)), region, at);
  Ros1Record record;
  record.offset = at;
  if (reader.left() < kLength) {
    reader.refuse(fmt::format("is cut off: {} bytes where a record is due", reader.left()));
  }
  const auto header = reader.number<std::uint32_t>();
  if (header > reader.left()) {
    const bool is_swapped = number_at<std::uint32_t>(bytes.subspan(static_cast<std::size_t>(at)),
                                                     std::endian::big) <= kTuning.longest_header;
    region.refuse(at, is_swapped
                          ? "is damaged, or of another byte order: ROS 1 writes the lowest first"
                          : fmt::format("is cut off or damaged: a record with a header of {} bytes "
                                        "begins here, {} are left",
                                        header, reader.left()));
  }
  record.header = Ros1Fields(reader.take(header), region, at + kLength);
  record.op = static_cast<Ros1Op>(record.header.number<std::uint8_t>("op"));
  const auto data = reader.left() < kLength ? UINT32_MAX : reader.number<std::uint32_t>();
  if (data > reader.left()) {
    region.refuse(at, fmt::format("is cut off or damaged: a record of {} bytes begins here, {} are "
                                  "left",
                                  data, reader.left()));
  }
  record.data_offset = reader.offset();
  record.data = reader.take(data);
  return record;
}

}  // namespace

Ros1Fields::Ros1Fields(std::span<const std::byte> bytes, const Region& region, std::uint64_t offset)
    : bytes_(bytes), region_(&region), offset_(offset) {
  if (!are(bytes)) {
    region.refuse(offset, "is damaged: no fields name=value stand here");
  }
}

bool Ros1Fields::are(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    if (!take_field(bytes)) {
      return false;
    }
  }
  return true;
}

std::optional<std::string_view> Ros1Fields::find(std::string_view name) const {
  for (std::span<const std::byte> left = bytes_; !left.empty();) {
    const std::string_view field = *take_field(left);
    if (field.size() > name.size() && field.starts_with(name) && field[name.size()] == '=') {
      return field.substr(name.size() + 1);
    }
  }
  return std::nullopt;
}

std::string_view Ros1Fields::text(std::string_view name) const {
  const auto found = find(name);
  if (!found) {
    region_->refuse(offset_, fmt::format("is damaged: a record has no field {}", name));
  }
  return *found;
}

std::string_view Ros1Fields::value(std::string_view name, std::size_t size) const {
  const std::string_view found = text(name);
  if (found.size() != size) {
    region_->refuse(offset_, fmt::format("is damaged: the field {} has {} bytes; {} are due", name,
                                         found.size(), size));
  }
  return found;
}

Ros1Record Ros1Cursor::next(const Region& region) {
  try {
    Ros1Record record = record_at(bytes_, at_, region);
    at_ = record.data_offset + record.data.size();
    return record;
  } catch (const InputError&) {
    do {
      ++at_;
    } while (!done() && !begins_record(bytes_.subspan(static_cast<std::size_t>(at_))));
    throw;
  }
}

}  // namespace kelpie::bag
