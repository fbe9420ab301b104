// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bag/decoding.hpp"

namespace kelpie::bag {

inline constexpr std::size_t kMostUlogPadding = 7;  ///< bytes at the end of a message

/// Formats of a ULog file by name: of "vehicle_attitude:uint64_t timestamp;float[4] q;…" the fields
/// by the name before the colon.
using UlogFormats = std::map<std::string, std::string, std::less<>>;

/// The definition of a topic: the format, followed by the formats used, a line each. Missing
/// formats are left out.
std::string ulog_definition(const std::string& name, const UlogFormats& formats);

/// The encoding "ulog": a message is the data behind the subscription number. Padding inside is
/// skipped; padding at the end is not part of the type. Throws InputError (type) on missing or
/// recursive formats, malformed types or fields, more than 20,000 fields.
MessageType ulog_type_of(const Topic& topic, const MessageDefinitions& definitions);

/// Accepts padding at the end, too.
void visit_ulog_numbers(const MessageType& type, std::span<const std::byte> message,
                        NumberVisitor& visitor);

/// timestamp.
std::vector<StampPart> ulog_stamp_of(const MessageType& type);

}  // namespace kelpie::bag
