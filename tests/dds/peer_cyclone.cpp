// SPDX-License-Identifier: Apache-2.0
// A process beside the test that uses the same room as the program: peer_cyclone DOMAIN.

#include <cstring>
#include <optional>

#include "bag/message_builder.hpp"
#include "dds/peer_commands.hpp"
#include "dds/publication.hpp"
#include "dds/subscription.hpp"

namespace {

using kelpie::testing::Bytes;
namespace dds = kelpie::dds;

class CyclonePeer : public kelpie::testing::PeerActions {
 public:
  explicit CyclonePeer(std::uint32_t domain) : participant_(dds::Network::loopback(domain)) {}
  ~CyclonePeer() override {
    ended_ = true;
    teller_.join();
  }

  void publish(const std::string& topic, const std::string& type, bool reliable) override {
    publication_.emplace(participant_, topic, type, quality_of(reliable));
  }
  void subscribe(const std::string& topic, const std::string& type, bool reliable) override {
    subscription_.emplace(participant_, topic, type, quality_of(reliable), queue_, 0);
  }
  void send(const Bytes& cdr) override { publication_->publish(cdr); }
  void send_odometry(std::int32_t sec, double velocity) override {
    kelpie::bag::MessageBuilder odometry(
        kelpie::bag::MessageDefinitions().type("nav_msgs/msg/Odometry"));
    odometry.set("header.stamp.sec", sec);
    odometry.set("child_frame_id", "base_link");
    odometry.set("twist.twist.linear.x", velocity);
    publication_->publish(odometry.bytes());
  }

 private:
  static dds::Quality quality_of(bool reliable) {
    return reliable ? dds::Quality::standard() : dds::Quality::sensor_data();
  }
  void tell() {
    dds::Message message;
    while (!ended_) {
      if (queue_.take(message, std::chrono::milliseconds(20))) {
        kelpie::testing::say_heard(message.cdr);
      }
    }
  }

  dds::MessageQueue queue_;
  dds::Participant participant_;
  std::optional<dds::Publication> publication_;
  std::optional<dds::Subscription> subscription_;
  std::atomic<bool> ended_ = false;
  std::thread teller_{[this] { tell(); }};
};

}  // namespace

int main(int, char** argv) {
  CyclonePeer peer(static_cast<std::uint32_t>(std::stoul(argv[1])));
  return kelpie::testing::run_peer(peer);
}
