// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bag/decoding.hpp"

namespace kelpie::bag {

/// A format of a ULog file, "vehicle_attitude:uint64_t timestamp;float[4] q;…": the fields of each
/// name, which is the part before the colon.
using UlogFormats = std::map<std::string, std::string, std::less<>>;

/// The definition of a topic: its format and those that it holds, a line each, its own first.
/// Formats that are missing are left out.
std::string ulog_definition(const std::string& name, const UlogFormats& formats);

/// The encoding "ulog": a message is what stands behind the number of its subscription. Padding
/// within it is passed over; the last field's is not in it. Throws InputError (type) on formats
/// that are missing or hold themselves, a type or field that isn't one, more than 20,000 fields.
MessageType ulog_type_of(const Topic& topic, const MessageDefinitions& definitions);

/// Padding at the end may be there as well.
void visit_ulog_numbers(const MessageType& type, std::span<const std::byte> message,
                        NumberVisitor& visitor);

/// timestamp.
std::vector<StampPart> ulog_stamp_of(const MessageType& type);

}  // namespace kelpie::bag
