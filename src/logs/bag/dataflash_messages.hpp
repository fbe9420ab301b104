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

/// Bytes before the payload of a message: A3 95 and the message number.
inline constexpr std::size_t kDataflashHead = 3;

/// Definition of a message number by FMT, with the units by FMTU.
struct DataflashFormat {
  std::size_t bytes = 0;  ///< of a message with head; 0: undefined
  std::string name{};     ///< "IMU"
  std::string letters{};  ///< a letter per field: the type
  std::string columns{};  ///< names of the fields, separated by commas
  std::string units{};    ///< a letter per field (DataflashUnits); may be shorter
  std::string factors{};

  bool operator==(const DataflashFormat& other) const = default;
};

/// Meaning of FMTU's letters, defined by UNIT and MULT.
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
/// The fields of a format, up to the first unknown letter.
std::vector<DataflashField> fields_of(const DataflashFormat& format);

/// The definition of a topic: a line per field, "h Roll deg 0.01": letter, name, unit ("-" without
/// unit), factor. The factor belongs to the letter (c, C, e, E: 0.01; L: 1e-7), or else to MULT;
/// never both, because MULT repeats the factor of the letter. Time stamps stay in µs.
std::string dataflash_definition(const DataflashFormat& format, const DataflashUnits& units = {});

/// The encoding "dataflash": a message is the payload behind the head. Throws InputError (type) on
/// an unknown letter.
MessageType dataflash_type_of(const Topic& topic, const MessageDefinitions& definitions);

/// TimeUS, or TimeMS of old firmware.
std::vector<StampPart> dataflash_stamp_of(const MessageType& type);

}  // namespace kelpie::bag
