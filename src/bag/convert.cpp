// SPDX-License-Identifier: Apache-2.0
#include "bag/convert.hpp"

#include "bag/decoding.hpp"

namespace kelpie::bag {

McapCopy copy_to_mcap(MessageReader& bag, const MessageDefinitions& definitions,
                      const McapWriter::Settings& settings) {
  McapCopy copy;
  McapWriter writer(settings);
  std::size_t added = 0;
  const auto add_new_topics = [&] {
    for (; added < bag.topics().size(); ++added) {
      Topic topic = bag.topics()[added];
      try {
        topic.definition = definition_of(topic, definitions);
      } catch (const InputError&) {  // of use all the same to who has the definition
        copy.undefined.push_back(topic.name);
      }
      writer.add_topic(topic);
    }
  };
  for (Message message; bag.next(message);) {
    add_new_topics();
    writer.write(message);
    ++copy.messages;
  }
  add_new_topics();
  copy.content = writer.finish();
  return copy;
}

}  // namespace kelpie::bag
