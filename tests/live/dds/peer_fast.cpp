// SPDX-License-Identifier: Apache-2.0
// A process beside the test that uses another vendor's DDS, as ROS 2's rmw_fastrtps does: its names
// of topics and types, its quality of service, its CDR. peer_fast DOMAIN.

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>

#include <algorithm>
#include <array>

#include "dds/peer_commands.hpp"

// Fast DDS 2.9 of Debian deletes some of its objects by the size of their base.
extern "C" const char* __asan_default_options() {  // NOLINT: the sanitizer's name
  return "new_delete_type_mismatch=0:detect_leaks=0";
}

namespace {

namespace fast = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using eprosima::fastcdr::Cdr;
using eprosima::fastcdr::FastBuffer;
using kelpie::testing::Bytes;
using kelpie::testing::say;

constexpr std::uint32_t kMostBytes = 200'000;

// Bytes under whatever name: what rosidl would generate is done by hand below.
class RawType : public fast::TopicDataType {
 public:
  explicit RawType(const std::string& name) {
    setName(name.c_str());
    m_typeSize = kMostBytes;
    auto_fill_type_object(false);
    auto_fill_type_information(false);
  }
  bool serialize(void* data, rtps::SerializedPayload_t* payload) override {
    const Bytes& bytes = *static_cast<Bytes*>(data);
    std::ranges::copy(bytes, reinterpret_cast<std::byte*>(payload->data));
    payload->length = static_cast<std::uint32_t>(bytes.size());
    return true;
  }
  bool deserialize(rtps::SerializedPayload_t* payload, void* data) override {
    const auto* const first = reinterpret_cast<const std::byte*>(payload->data);
    static_cast<Bytes*>(data)->assign(first, first + payload->length);
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] { return static_cast<std::uint32_t>(static_cast<Bytes*>(data)->size()); };
  }
  void* createData() override { return new Bytes; }
  void deleteData(void* data) override { delete static_cast<Bytes*>(data); }
  bool getKey(void* /*data*/, rtps::InstanceHandle_t* /*key*/, bool /*md5*/) override {
    return false;
  }
};

// Reads what was received with this vendor's CDR, or says why that failed.
template <typename Read>
std::string read_cdr(Bytes& bytes, const Read& read) {
  try {
    FastBuffer buffer(reinterpret_cast<char*>(bytes.data()), bytes.size());
    Cdr cdr(buffer, Cdr::DEFAULT_ENDIAN, Cdr::DDS_CDR);
    cdr.read_encapsulation();
    return read(cdr);
  } catch (const std::exception& error) {
    return std::string("unreadable: ") + error.what();
  }
}

std::string header_of(Cdr& cdr) {
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
  std::string frame;
  cdr >> sec >> nanosec >> frame;
  return std::to_string(sec) + "." + std::to_string(nanosec) + " " + frame;
}

std::string acceleration_of(Cdr& cdr) {
  std::string text = header_of(cdr);
  std::array<double, 6> accel{};
  std::array<double, 36> covariance{};
  cdr >> accel >> covariance;
  for (const double value : accel) {
    text += " " + std::to_string(value);
  }
  return text + " " + std::to_string(covariance.front()) + " " + std::to_string(covariance.back());
}

std::string diagnostics_of(Cdr& cdr) {
  std::string text = header_of(cdr);
  std::uint32_t count = 0;
  cdr >> count;
  for (std::uint32_t i = 0; i < count; ++i) {
    std::uint8_t level = 0;
    std::array<std::string, 3> words;
    std::uint32_t values = 0;
    cdr >> level >> words[0] >> words[1] >> words[2] >> values;
    text += " [" + std::to_string(level) + " " + words[0] + ": " + words[1];
    for (std::uint32_t k = 0; k < values; ++k) {
      std::array<std::string, 2> pair;
      cdr >> pair[0] >> pair[1];
      text += ", " + pair[0] + "=" + pair[1];
    }
    text += "]";
  }
  return text;
}

class Listener : public fast::DataReaderListener {
 public:
  void on_data_available(fast::DataReader* reader) override {
    Bytes bytes;
    fast::SampleInfo info;
    while (reader->take_next_sample(&bytes, &info) == ReturnCode_t::RETCODE_OK) {
      if (!info.valid_data) {
        continue;
      }
      const std::string type = reader->type().get_type_name();
      if (bytes != kelpie::testing::hello() &&
          type == "geometry_msgs::msg::dds_::AccelWithCovarianceStamped_") {
        say("accel " + read_cdr(bytes, acceleration_of));
      } else if (bytes != kelpie::testing::hello() &&
                 type == "diagnostic_msgs::msg::dds_::DiagnosticArray_") {
        say("diagnostics " + read_cdr(bytes, diagnostics_of));
      } else {
        kelpie::testing::say_heard(bytes);
      }
    }
  }
};

// Only this machine: UDP on 127.0.0.1, no multicast, no shared memory.
fast::DomainParticipantQos loopback_only() {
  fast::DomainParticipantQos qos = fast::PARTICIPANT_QOS_DEFAULT;
  auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList = {"127.0.0.1"};
  qos.transport().use_builtin_transports = false;
  qos.transport().user_transports.push_back(udp);
  rtps::Locator_t here;
  here.kind = LOCATOR_KIND_UDPv4;
  rtps::IPLocator::setIPv4(here, "127.0.0.1");
  qos.wire_protocol().builtin.initialPeersList.push_back(here);
  qos.wire_protocol().builtin.metatrafficUnicastLocatorList.push_back(here);
  qos.wire_protocol().builtin.avoid_builtin_multicast = true;
  return qos;
}

class FastPeer : public kelpie::testing::PeerActions {
 public:
  explicit FastPeer(std::uint32_t domain)
      : participant_(fast::DomainParticipantFactory::get_instance()->create_participant(
            domain, loopback_only())) {}
  ~FastPeer() override {
    participant_->delete_contained_entities();
    fast::DomainParticipantFactory::get_instance()->delete_participant(participant_);
  }

  void publish(const std::string& topic, const std::string& type, bool reliable) override {
    fast::Publisher* const publisher = participant_->create_publisher(fast::PUBLISHER_QOS_DEFAULT);
    fast::DataWriterQos qos = fast::DATAWRITER_QOS_DEFAULT;
    qos.reliability().kind =
        reliable ? fast::RELIABLE_RELIABILITY_QOS : fast::BEST_EFFORT_RELIABILITY_QOS;
    qos.durability().kind = fast::VOLATILE_DURABILITY_QOS;
    qos.history().depth = 10;
    qos.reliable_writer_qos().times.heartbeatPeriod = {0, 100'000'000};  // send() waits for one
    qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
    qos.publish_mode().kind = fast::SYNCHRONOUS_PUBLISH_MODE;
    writers_.push_back(publisher->create_datawriter(topic_of(topic, type), qos));
  }
  void subscribe(const std::string& topic, const std::string& type, bool reliable) override {
    fast::Subscriber* const subscriber =
        participant_->create_subscriber(fast::SUBSCRIBER_QOS_DEFAULT);
    fast::DataReaderQos qos = fast::DATAREADER_QOS_DEFAULT;
    qos.reliability().kind =
        reliable ? fast::RELIABLE_RELIABILITY_QOS : fast::BEST_EFFORT_RELIABILITY_QOS;
    qos.history().depth = 10;
    qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
    subscriber->create_datareader(topic_of(topic, type), qos, &listener_);
  }
  void send_odometry(std::int32_t sec, double velocity) override {
    send(odometry(sec, 0, {velocity}));
  }
  void send_motion(const kelpie::testing::Swimming& vehicle) override {
    const auto& [x, y, turn] = vehicle.force;
    send_by(1, cdr_of([&](Cdr& cdr) {
              cdr << vehicle.sec() << vehicle.nanosec() << std::string("base_link");
              // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): the names are set above
              cdr << std::array<double, 6>{x, y, 0.0, 0.0, 0.0, turn};
            }));
    const auto& [u, v, r] = vehicle.velocity;
    send_by(0, odometry(vehicle.sec(), vehicle.nanosec(), {u, v, 0.0, 0.0, 0.0, r}));
  }
  void send_text(const std::string& text) override {
    send(cdr_of([&](Cdr& cdr) { cdr << text; }));
  }
  // Before a message of many packets, waits for the acknowledgement of earlier messages, without
  // which a reader may not have had a heartbeat yet: Cyclone DDS takes such a message that the
  // first heartbeat overtakes for an earlier message.
  void send(const Bytes& cdr) override {
    if (constexpr std::size_t kPacket = 60'000; cdr.size() > kPacket) {
      const eprosima::fastrtps::Duration_t patience{30, 0};
      writers_.back()->wait_for_acknowledgments(patience);
    }
    send_by(writers_.size() - 1, cdr);
  }

 private:
  template <typename Write>
  static Bytes cdr_of(const Write& write) {
    FastBuffer buffer;
    Cdr cdr(buffer, Cdr::DEFAULT_ENDIAN, Cdr::DDS_CDR);
    cdr.serialize_encapsulation();
    write(cdr);
    const auto* const first = reinterpret_cast<const std::byte*>(cdr.getBufferPointer());
    return {first, first + cdr.getSerializedDataLength()};
  }
  static Bytes odometry(std::int32_t sec, std::uint32_t nanosec,
                        const std::array<double, 6>& twist) {
    return cdr_of([&](Cdr& cdr) {
      cdr << sec << nanosec << std::string("odom") << std::string("base_link");
      cdr << std::array<double, 7>{} << std::array<double, 36>{};
      cdr << twist << std::array<double, 36>{};
    });
  }
  void send_by(std::size_t writer, const Bytes& cdr) {
    Bytes copy = cdr;
    writers_[writer]->write(&copy);
  }

  // "/odom" and "nav_msgs/msg/Odometry" as they are called on DDS.
  fast::Topic* topic_of(const std::string& topic, const std::string& type) {
    const std::size_t first = type.find('/');
    const std::string name =
        type.substr(0, first) + "::msg::dds_::" + type.substr(type.rfind('/') + 1) + "_";
    fast::TypeSupport(new RawType(name)).register_type(participant_);
    return participant_->create_topic("rt" + topic, name, fast::TOPIC_QOS_DEFAULT);
  }

  fast::DomainParticipant* participant_;
  std::vector<fast::DataWriter*> writers_;
  Listener listener_;
};

}  // namespace

int main(int /*argc*/, char** argv) {
  try {
    FastPeer peer(static_cast<std::uint32_t>(std::stoul(argv[1])));
    return kelpie::testing::run_peer(peer);
  } catch (const std::exception& error) {
    std::cerr << argv[0] << ": " << error.what() << "\n";
    return 2;
  }
}
