// SPDX-License-Identifier: Apache-2.0
#include "bag/decoding.hpp"

namespace kelpie::bag {

MessageType cdr_type_of(const Topic& topic, const MessageDefinitions& definitions) {
  if (topic.encoding != "cdr") {
    throw InputError("its messages are encoded as '" + topic.encoding + "'; only cdr is decoded");
  }
  return definitions.type(topic.type, topic.definition);
}

bool decode(BagReader& bag, const Message& message, const MessageType& type,
            NumberVisitor& visitor) {
  try {
    visit_numbers(type, message.data, visitor);
    return true;
  } catch (const InputError& error) {
    bag.lose(InputError(bag.place(), error.what()));
    return false;
  }
}

}  // namespace kelpie::bag
