// SPDX-License-Identifier: Apache-2.0
// Service indexes of nodes that anybody can have announced: what their answers may cost.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <atomic>
#include <chrono>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "rr/discovery.hpp"
#include "rr/node.hpp"
#include "runtime/cpp/src/discovery/packets.hpp"
#include "runtime/cpp/src/discovery/testing.hpp"
#include "runtime/cpp/src/endpoint/service_index_types.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/raw_service.hpp"

namespace rr::discovery {
namespace {

using namespace std::chrono_literals;
using rr::testing::RawService;
using service_index::ServiceInfo;
using service_index::ServiceInfos;
using ::testing::Contains;
using ::testing::HasSubstr;
using ServiceRequest = RawService::Request;

// Services of one node whose index takes about so many bytes.
ServiceInfos infos_of(std::size_t bytes) {
  std::map<std::int32_t, std::optional<ServiceInfo>> infos;
  for (std::size_t i = 0; i * 1'000 < bytes; ++i) {
    ServiceInfo info;
    info.Name = "s" + std::to_string(i) + std::string(900, 'x');
    info.RootObjectType = "test.counter.Counter";
    infos.emplace(static_cast<std::int32_t>(i), std::move(info));
  }
  return infos;
}

class IndexLimits : public ::testing::Test {
 protected:
  IndexLimits() : finder_(keeping_log()) { finder_.discovery().listen(listening_at(network_)); }

  /// A node whose index answers as `handler` says. It is announced once.
  void announce(std::unique_ptr<RawService>& index, const std::string& definition,
                RawService::Handler handler) const {
    index = std::make_unique<RawService>(definition, "RobotRaconteurServiceIndex.ServiceIndex",
                                         std::move(handler));
    const std::string packet = write_announcement(
        {index->node(), "raw.service",
         service_index::service_url("rr+tcp://127.0.0.1:" + std::to_string(index->port()),
                                    index->node(), service_index::service_name),
         "nonce"});
    const channel::Descriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
    sockaddr_in place{};
    place.sin_family = AF_INET;
    place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    place.sin_port = htons(network_.port);
    sendto(socket.get(), packet.data(), packet.size(), 0, reinterpret_cast<const sockaddr*>(&place),
           sizeof place);
  }
  /// What is known of services, once nothing more is asked.
  std::vector<FoundService> find() const {
    EXPECT_TRUE(
        rr::testing::eventually([&] { return !finder_.discovery().detected_nodes().empty(); }));
    return finder_.discovery().find_services("test.counter.Counter", {.timeout = 10s});
  }
  std::vector<std::string> lines() const {
    const std::lock_guard lock(mutex_);
    return lines_;
  }

  const std::string definition_{service_index::definition.text};
  const DiscoveryNetwork network_ = loopback_network();

 private:
  NodeOptions keeping_log() {
    NodeOptions options;
    options.log = [this](LogLevel /*level*/, std::string_view text) {
      const std::lock_guard lock(mutex_);
      lines_.emplace_back(text);
    };
    return options;
  }

  mutable std::mutex mutex_;
  std::vector<std::string> lines_;
  Node finder_;
};

// Answers the question for the services with about so many bytes.
RawService::Handler answering(std::unique_ptr<RawService>& index, std::size_t bytes,
                              std::atomic<int>& asked) {
  return [&index, bytes, &asked](const ServiceRequest& request) {
    if (request.type != EntryType::function_call_req) return false;
    ++asked;
    RawService::Answer answer = RawService::answer_to(request);
    answer.elements = RawService::value("return", infos_of(bytes));
    index->send(answer);
    return true;
  };
}

TEST_F(IndexLimits, AnAnswerOfUsualSizeCounts) {
  std::unique_ptr<RawService> index;
  std::atomic<int> asked{0};
  announce(index, definition_, answering(index, 50'000, asked));
  EXPECT_EQ(find().size(), 50U);
  EXPECT_EQ(asked, 1);
}

TEST_F(IndexLimits, AnAnswerThatIsTooLargeIsNotRead) {
  std::unique_ptr<RawService> index;
  std::atomic<int> asked{0};
  announce(index, definition_, answering(index, 300'000, asked));
  EXPECT_TRUE(find().empty());
  EXPECT_GE(asked, 1);
  EXPECT_THAT(lines(), Contains(HasSubstr("says too much")));
}

// What the kernel takes of it on both sides, but not more.
TEST_F(IndexLimits, AnAnswerOfManyMegabytesIsNotReceived) {
  std::unique_ptr<RawService> index;
  std::atomic<int> asked{0};
  announce(index, definition_, answering(index, 11'000'000, asked));
  EXPECT_TRUE(find().empty());
  ASSERT_GE(asked, 1);
  EXPECT_LT(index->sent(), static_cast<std::size_t>(asked) * 9'000'000);
}

TEST_F(IndexLimits, DefinitionsOfAnIndexAreFew) {
  std::unique_ptr<RawService> index;
  std::atomic<int> asked{0};
  announce(index, "", [&](const ServiceRequest& request) {
    if (request.type != EntryType::get_service_desc) return false;
    const int number = ++asked;
    RawService::Answer answer = RawService::answer_to(request);
    const std::string name =
        request.service_type.empty() ? "RobotRaconteurServiceIndex" : request.service_type;
    answer.elements = RawService::value("servicedef", "service " + name + "\nimport x.c" +
                                                          std::to_string(number) +
                                                          "\nobject ServiceIndex\nend\n");
    index->send(answer);
    return true;
  });
  EXPECT_TRUE(find().empty());
  ASSERT_GE(asked, 1);
  EXPECT_LE(asked, 3 * 9) << "three attempts";
}

}  // namespace
}  // namespace rr::discovery
