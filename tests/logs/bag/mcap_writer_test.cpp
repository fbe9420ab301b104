// SPDX-License-Identifier: Apache-2.0
#include "bag/mcap_writer.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "bag/bags.hpp"

namespace kelpie::mcap_writer_test {
namespace {

using testing::Content;
using testing::mcap_of;
using testing::read_all;
using testing::Recorded;

bool same(const Recorded& a, const Recorded& b) {
  return a.topic == b.topic && a.receive_ns == b.receive_ns && a.data == b.data;
}

RC_GTEST_PROP(McapWriter, WhatIsWrittenIsReadAgain, ()) {
  const std::vector<bag::Topic> topics{
      {.name = "/a", .type = "a/msg/A", .definition = "float64 x\n", .qos_profiles = "- depth: 1"},
      {.name = "/b", .type = "b/msg/B", .encoding = "json"},
  };
  const auto recorded = rc::gen::map(
      rc::gen::tuple(rc::gen::inRange<std::size_t>(0, 2),
                     rc::gen::inRange<std::int64_t>(0, std::int64_t{1} << 61),
                     rc::gen::arbitrary<std::string>()),
      [](const auto& parts) {
        const auto bytes = testing::as_bytes(std::get<2>(parts));
        return Recorded{std::get<0>(parts), std::get<1>(parts), {bytes.begin(), bytes.end()}};
      });
  const auto messages = *rc::gen::container<std::vector<Recorded>>(recorded);
  const bag::McapWriter::Settings settings{
      .compression = *rc::gen::element<std::string>("zstd", "lz4", ""),
      .chunk_bytes = *rc::gen::inRange<std::size_t>(1, 2000)};
  const std::string file = mcap_of(topics, messages, settings);
  const Content content = read_all(file);
  RC_ASSERT(std::ranges::equal(content.messages, messages, same));
  RC_ASSERT(content.topics.size() == 2U);
  RC_ASSERT(content.topics[0].definition == topics[0].definition);
  RC_ASSERT(content.topics[0].qos_profiles == topics[0].qos_profiles);
  RC_ASSERT(content.topics[1].encoding == "json");
  RC_ASSERT(content.topics[1].type == "b/msg/B");
  RC_ASSERT(file == mcap_of(topics, messages, settings));
}

TEST(McapWriter, ABagWithoutMessagesIsAFile) {
  EXPECT_EQ(read_all(mcap_of(testing::small_topics(), {})).topics.size(), 2U);
  EXPECT_TRUE(read_all(mcap_of({}, {})).topics.empty());
}

TEST(McapWriter, ChunksAreCompressed) {
  const std::vector<Recorded> messages(100, {0, 1, testing::twist_stamped(1, 0.5)});
  const std::size_t plain = mcap_of(testing::small_topics(), messages, {.compression = ""}).size();
  for (const char* const compression : {"zstd", "lz4"}) {
    EXPECT_LT(mcap_of(testing::small_topics(), messages, {.compression = compression}).size(),
              plain / 2)
        << compression;
  }
}

}  // namespace
}  // namespace kelpie::mcap_writer_test
