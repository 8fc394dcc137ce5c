// SPDX-License-Identifier: Apache-2.0
// Discovery between three network namespaces, of which two are linked to a bridge in the third.
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "runtime/cpp/src/node/testing/child.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"

namespace rr::discovery {
namespace {

using namespace std::chrono_literals;
using rr::testing::Child;
using rr::testing::eventually;

constexpr std::chrono::milliseconds period{3'000};
constexpr std::chrono::milliseconds lifetime{5'000};

/// The three, while it exists.
class Networks {
 public:
  Networks() {
    is_there_ = ::geteuid() == 0;
    for (int i = 0; i < 3 && is_there_; ++i) {
      is_there_ = run("ip netns add " + space(i)) &&
                  run(in(i) + "sh -c 'echo 0 > /proc/sys/net/ipv6/conf/default/accept_dad'") &&
                  run(in(i) + "ip link set lo up");
    }
    is_there_ = is_there_ && run(in(0) + "ip link add bridge type bridge") &&
                run(in(0) + "ip link set bridge up");
    for (int i = 1; i < 3 && is_there_; ++i) {
      const std::string near = "port" + std::to_string(i);
      is_there_ =
          run(in(0) + "ip link add " + near + " type veth peer name far netns " + space(i)) &&
          run(in(0) + "ip link set " + near + " master bridge up") &&
          run(in(i) + "ip link set far up");
    }
  }
  ~Networks() {
    for (int i = 0; i < 3; ++i) run("ip netns del " + space(i));
  }
  Networks(const Networks&) = delete;
  Networks& operator=(const Networks&) = delete;

  [[nodiscard]] bool is_there() const { return is_there_; }
  bool cut(int number) const {
    return run(in(0) + "ip link set port" + std::to_string(number) + " down");
  }
  bool join(int number) const {
    return run(in(0) + "ip link set port" + std::to_string(number) + " up");
  }
  /// The program of the other processes, in one of them.
  [[nodiscard]] Child start(int number, const std::vector<std::string>& arguments) const {
    std::vector<std::string> words = {"netns", "exec", space(number), RR_DISCOVERY_PEER};
    words.insert(words.end(), arguments.begin(), arguments.end());
    return Child(words, "ip");
  }

 private:
  [[nodiscard]] std::string space(int number) const {
    return "rrdisc" + std::to_string(::getpid()) + "x" + std::to_string(number);
  }
  [[nodiscard]] std::string in(int number) const { return "ip netns exec " + space(number) + " "; }
  static bool run(const std::string& command) {
    return std::system((command + " 2>/dev/null").c_str()) == 0;
  }

  bool is_there_ = false;
};

/// What a watching process has found.
struct Watcher {
  explicit Watcher(Child started) : child(std::move(started)) { child.wait_for("ready"); }

  void read() {
    for (const std::string& line : child.take_lines()) {
      const std::size_t blank = line.find(' ');
      const std::string word = line.substr(0, blank);
      const std::string id = blank == std::string::npos ? "" : line.substr(blank + 1);
      if (word == "came") nodes.insert(id);
      if (word == "went") nodes.erase(id);
      if (word == "service") services.insert(id);
      if (word == "gone") services.erase(id);
    }
  }
  bool sees(const std::set<std::string>& wanted) {
    return eventually([&] {
      read();
      return nodes == wanted;
    });
  }
  bool sees_services(const std::set<std::string>& wanted) {
    return eventually([&] {
      read();
      return services == wanted;
    });
  }

  Child child;
  std::set<std::string> nodes;
  std::set<std::string> services;
};

/// Some nodes in a network.
struct Nodes {
  Nodes(const Networks& networks, int number, int count)
      : child(networks.start(number,
                             {"nodes", std::to_string(count), std::to_string(period.count())})) {
    for (int i = 0; i < count; ++i) ids.insert(child.wait_for("node"));
    child.wait_for("ready");
  }
  Child child;
  std::set<std::string> ids;
};

TEST(Discovery, FindsFiftyNodesInThreeNetworksAndFollowsTheirLinks) {
  const Networks networks;
  if (!networks.is_there()) {
    GTEST_SKIP() << "left out: network namespaces need root and the program ip";
  }
  Watcher watcher(networks.start(0, {"watch", std::to_string(lifetime.count())}));
  const Nodes near(networks, 0, 16);
  const Nodes one(networks, 1, 17);
  const Nodes two(networks, 2, 17);
  const auto begin = std::chrono::steady_clock::now();
  std::set<std::string> all = near.ids;
  all.insert(one.ids.begin(), one.ids.end());
  all.insert(two.ids.begin(), two.ids.end());
  ASSERT_EQ(all.size(), 50U);

  ASSERT_TRUE(watcher.sees(all));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 2 * period);
  EXPECT_TRUE(watcher.sees_services(all));

  std::set<std::string> rest = near.ids;
  rest.insert(two.ids.begin(), two.ids.end());
  ASSERT_TRUE(networks.cut(1));
  EXPECT_TRUE(watcher.sees(rest));
  EXPECT_TRUE(watcher.sees_services(rest));

  ASSERT_TRUE(networks.join(1));
  const auto joined = std::chrono::steady_clock::now();
  ASSERT_TRUE(watcher.sees(all));
  EXPECT_LT(std::chrono::steady_clock::now() - joined, 2 * period);
  EXPECT_TRUE(watcher.sees_services(all));
}

}  // namespace
}  // namespace rr::discovery
