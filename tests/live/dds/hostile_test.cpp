// SPDX-License-Identifier: Apache-2.0
// Bytes that nobody should send: they end in an error that is said, and the next good message
// comes.

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <random>

#include "bag/cdr.hpp"
#include "bag/message_builder.hpp"
#include "dds/loopback.hpp"
#include "dds/peer_commands.hpp"
#include "dds/publication.hpp"
#include "dds/subscription.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie::hostile_test {
namespace {

using dds::Quality;
using testing::Bytes;
using testing::connected;
using testing::eventually;

class Ignore : public bag::NumberVisitor {
 public:
  bool wants(std::size_t /*field*/) const override { return true; }
  void number(std::size_t /*field*/, std::span<const std::uint32_t> /*index*/,
              double /*value*/) override {}
};

struct Room {
  dds::Participant participant{dds::Network::loopback(testing::own_domain())};
  dds::MessageQueue queue{4'000};
  dds::Subscription states{participant,         "/joints", "sensor_msgs/msg/JointState",
                           Quality::standard(), queue,     0};
  bag::MessageType type = bag::MessageDefinitions().type("sensor_msgs/msg/JointState");
  dds::TopicSample message;

  Bytes good() const {
    bag::MessageBuilder builder(type);
    builder.set("name[0]", "port");
    builder.set("name[1]", "starboard");
    builder.set("velocity", std::vector<double>{12.5, -3.0});
    const auto bytes = builder.bytes();
    return {bytes.begin(), bytes.end()};
  }
  // Cut off everywhere, and every length in it a lie.
  std::vector<Bytes> bad() const {
    const Bytes whole = good();
    std::vector<Bytes> all;
    for (std::size_t length = 0; length < whole.size(); ++length) {
      all.emplace_back(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length));
    }
    for (std::size_t at = 4; at + 4 <= whole.size(); at += 4) {
      Bytes lie = whole;
      std::fill_n(lie.begin() + static_cast<std::ptrdiff_t>(at), 4, std::byte{0xFF});
      all.push_back(lie);
    }
    return all;
  }
  // Decodes all that comes until a whole message does; false where none came.
  bool reaches_a_good_one() {
    while (queue.pop(message, testing::kPatience)) {
      if (message.cdr == good()) {
        return true;
      }
      Ignore ignore;
      try {
        bag::visit_numbers(type, message.cdr, ignore);
      } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("byte"), std::string::npos);
      }
    }
    return false;
  }
};

TEST(Hostile, MessagesOfThisProcessThatAreCutOffOrLie) {
  Room room;
  dds::Publication joints(room.participant, "/joints", "sensor_msgs/msg/JointState");
  ASSERT_TRUE(eventually([&] { return room.states.publishers() == 1; }));
  for (const Bytes& bytes : room.bad()) {
    EXPECT_TRUE(joints.publish(bytes));
  }
  EXPECT_TRUE(joints.publish(room.good()));
  EXPECT_TRUE(room.reaches_a_good_one());
  EXPECT_EQ(room.states.received(), room.bad().size() + 1);
}

#ifdef KELPIE_PEER_FAST

TEST(Hostile, MessagesOfAnotherVendorThatAreCutOffOrLie) {
  Room room;
  testing::Peer peer(KELPIE_PEER_FAST);
  peer.order("publish /joints sensor_msgs/msg/JointState reliable");
  ASSERT_TRUE(connected(peer, room.states));
  for (const Bytes& bytes : room.bad()) {
    peer.order("send " + testing::hex_of(bytes));
  }
  peer.order("send " + testing::hex_of(room.good()));
  EXPECT_TRUE(room.reaches_a_good_one());
}

TEST(Hostile, MessagesAboveTheLimitAreNotTaken) {
  dds::Network network = dds::Network::loopback(testing::own_domain());
  network.most_message_bytes = 20'000;
  const dds::Participant participant(network);
  dds::MessageQueue queue;
  const dds::Subscription images(participant, "/image", "sensor_msgs/msg/Image",
                                 Quality::standard(), queue, 0);
  testing::Peer peer(KELPIE_PEER_FAST);
  peer.order("publish /image sensor_msgs/msg/Image reliable");
  ASSERT_TRUE(connected(peer, images));
  peer.order("send " + testing::hex_of(Bytes(100'000, std::byte{1})));
  peer.order("send " + testing::hex_of(Bytes(8'000, std::byte{2})));
  dds::TopicSample message;
  ASSERT_TRUE(testing::take(queue, message));
  EXPECT_EQ(message.cdr.size(), 8'000U);
}

#endif

// A socket of this machine alone, at the port where a last participant would be asked.
class Intruder {
 public:
  explicit Intruder(std::uint32_t domain)
      : base_(7400 + 250 * domain + 10), socket_(::socket(AF_INET, SOCK_DGRAM, 0)) {
    const sockaddr_in here = address(30);
    const timeval patience{.tv_sec = testing::kPatience.count(), .tv_usec = 0};
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    bound_ = ::bind(socket_, reinterpret_cast<const sockaddr*>(&here), sizeof here) == 0;
  }
  ~Intruder() { ::close(socket_); }
  Intruder(const Intruder&) = delete;
  Intruder(Intruder&&) = delete;
  Intruder& operator=(const Intruder&) = delete;
  Intruder& operator=(Intruder&&) = delete;

  bool bound() const { return bound_; }
  Bytes hear() const {
    Bytes bytes(65'536);
    const ssize_t count = ::recv(socket_, bytes.data(), bytes.size(), 0);
    bytes.resize(static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
    return bytes;
  }
  // To both ports of the first participant: of discovery and of messages.
  void send(const Bytes& bytes) const {
    for (const std::uint32_t offset : {0U, 1U}) {
      const sockaddr_in there = address(0, offset);
      ::sendto(socket_, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&there),
               sizeof there);
    }
  }

 private:
  sockaddr_in address(std::uint32_t participant, std::uint32_t offset = 0) const {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(base_ + 2 * participant + offset));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return address;
  }

  std::uint32_t base_;
  int socket_;
  bool bound_ = false;
};

TEST(Hostile, PacketsThatAreNoneOrDamaged) {
  const Intruder intruder(testing::own_domain());
  ASSERT_TRUE(intruder.bound());
  Room room;
  const Bytes packet = intruder.hear();  // the participant makes itself known
  ASSERT_GT(packet.size(), 20U);
  std::mt19937 random(18);
  for (int k = 0; k < 3'000; ++k) {
    Bytes bytes = packet;
    for (std::uint32_t n = random() % 8; n > 0; --n) {
      bytes[20 + random() % (bytes.size() - 20)] = static_cast<std::byte>(random());
    }
    bytes.resize(k % 3 == 0 ? random() % bytes.size() : bytes.size());
    intruder.send(bytes);
  }
  for (std::size_t size = 0; size < 300; ++size) {
    Bytes noise(size);
    std::ranges::generate(noise, [&] { return static_cast<std::byte>(random()); });
    intruder.send(noise);
  }
  testing::Peer peer(KELPIE_PEER_CYCLONE);
  peer.order("publish /joints sensor_msgs/msg/JointState reliable");
  ASSERT_TRUE(connected(peer, room.states));
  peer.order("send " + testing::hex_of(room.good()));
  EXPECT_TRUE(room.reaches_a_good_one());
  EXPECT_GT(dds::Participant::damaged(), 100U);
}

}  // namespace
}  // namespace kelpie::hostile_test
