// SPDX-License-Identifier: Apache-2.0
// A process beside the test that uses the same room as the program: peer_cyclone DOMAIN.

#include <cstring>
#include <memory>
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
    publications_.push_back(
        std::make_unique<dds::Publication>(participant_, topic, type, quality_of(reliable)));
  }
  void subscribe(const std::string& topic, const std::string& type, bool reliable) override {
    subscription_.emplace(participant_, topic, type, quality_of(reliable), queue_, 0);
  }
  void send(const Bytes& cdr) override { publications_.back()->publish(cdr); }
  void send_odometry(std::int32_t sec, double velocity) override {
    odometry_.set("header.stamp.sec", sec);
    odometry_.set("child_frame_id", "base_link");
    odometry_.set("twist.twist.linear.x", velocity);
    send(odometry_);
  }
  void send_motion(const kelpie::testing::Swimming& vehicle) override {
    for (auto* const message : {&wrench_, &odometry_}) {
      message->set("header.stamp.sec", vehicle.sec());
      message->set("header.stamp.nanosec", vehicle.nanosec());
    }
    wrench_.set("wrench.force.x", vehicle.force[0]);
    wrench_.set("wrench.force.y", vehicle.force[1]);
    wrench_.set("wrench.torque.z", vehicle.force[2]);
    publications_[1]->publish(wrench_.bytes());
    odometry_.set("twist.twist.linear.x", vehicle.velocity[0]);
    odometry_.set("twist.twist.linear.y", vehicle.velocity[1]);
    odometry_.set("twist.twist.angular.z", vehicle.velocity[2]);
    publications_[0]->publish(odometry_.bytes());
  }
  void send_text(const std::string& text) override {
    text_.set("data", text);
    send(text_);
  }

 private:
  static kelpie::bag::MessageBuilder builder(const char* type) {
    return kelpie::bag::MessageBuilder(kelpie::bag::MessageDefinitions().type(type));
  }
  void send(kelpie::bag::MessageBuilder& message) {
    const std::span<const std::byte> bytes = message.bytes();
    send(Bytes(bytes.begin(), bytes.end()));
  }
  static dds::Quality quality_of(bool reliable) {
    return reliable ? dds::Quality::standard() : dds::Quality::sensor_data();
  }
  void tell() {
    dds::TopicSample message;
    while (!ended_) {
      if (queue_.pop(message, std::chrono::milliseconds(20))) {
        kelpie::testing::say_heard(message.cdr);
      }
    }
  }

  dds::MessageQueue queue_;
  dds::Participant participant_;
  std::vector<std::unique_ptr<dds::Publication>> publications_;
  kelpie::bag::MessageBuilder odometry_ = builder("nav_msgs/msg/Odometry");
  kelpie::bag::MessageBuilder wrench_ = builder("geometry_msgs/msg/WrenchStamped");
  kelpie::bag::MessageBuilder text_ = builder("std_msgs/msg/String");
  std::optional<dds::Subscription> subscription_;
  std::atomic<bool> ended_ = false;
  std::thread teller_{[this] { tell(); }};
};

}  // namespace

int main(int /*argc*/, char** argv) {
  try {
    CyclonePeer peer(static_cast<std::uint32_t>(std::stoul(argv[1])));
    return kelpie::testing::run_peer(peer);
  } catch (const std::exception& error) {
    std::cerr << argv[0] << ": " << error.what() << "\n";
    return 2;
  }
}
