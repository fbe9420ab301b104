// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bag/decoding.hpp"

namespace kelpie::bag {

/// The bytes before each message's own: A3 95 and its number.
inline constexpr std::size_t kDataflashHead = 3;

/// What FMT says of the messages of one number, and FMTU of their units.
struct DataflashFormat {
  std::size_t bytes = 0;  ///< of a message with its head; 0: no such message
  std::string name{};     ///< "IMU"
  std::string letters{};  ///< one per field: its kind
  std::string columns{};  ///< the fields' names, with commas between them
  std::string units{};    ///< one letter per field (DataflashUnits); may be shorter
  std::string factors{};

  bool operator==(const DataflashFormat& other) const = default;
};

/// What UNIT and MULT say of the letters of FMTU.
struct DataflashUnits {
  std::array<std::string, 256> units{};
  std::array<double, 256> factors{};  ///< 0: not told
};

/// Where within a message's own bytes a field stands.
struct DataflashField {
  std::string name;
  char letter;
  std::size_t offset;
};
/// The fields of a format as far as their letters are known.
std::vector<DataflashField> fields_of(const DataflashFormat& format);

/// The definition of a topic: a line per field, "h Roll deg 0.01": letter, name, unit ("-": none),
/// factor. The factor is that of the letter (c, C, e, E: 0.01; L: 1e-7), else that of MULT: never
/// both, for MULT says again what the letter does. A sender's time stays in µs.
std::string dataflash_definition(const DataflashFormat& format, const DataflashUnits& units = {});

/// The encoding "dataflash": a message is what stands behind its head. Throws InputError (type) on
/// a letter that isn't known.
MessageType dataflash_type_of(const Topic& topic, const MessageDefinitions& definitions);

/// TimeUS, or TimeMS of old firmware.
std::vector<StampPart> dataflash_stamp_of(const MessageType& type);

}  // namespace kelpie::bag
