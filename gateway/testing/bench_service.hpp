// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <semaphore>
#include <string>

#include "gateway/testing/waiting.hpp"
#include "rr/dynamic_service.hpp"
#include "rr/error.hpp"
#include "rr/node.hpp"

namespace rr::gateway::testing {

/// A robot with a member of each kind.
inline const std::string bench_definition = R"(service test.bench
stdver 0.10

exception Jam

enum Mode
  off = 0, slow = 1, fast = 2
end

struct Pose
  field double x
  field double[] q
end

object Tool
  property double width
  function void open()
  event opened(int32 count)
  wire double grip [readonly]
end

object Bench
  property double speed
  property Pose pose
  property Mode mode
  property int32 secret
  function double add(double a, double b)
  function string describe(string name, Pose pose)
  function void fail(string text)
  function int32 count()
  function string whoami()
  function double{generator} count_to(int32 last)
  function void collect(double{generator} value)
  function double{generator} sums(double start, double{generator} value)
  event stopped(string why, int32 code)
  pipe uint32 samples [readonly]
  pipe string commands [writeonly]
  pipe uint32 both
  wire double force [readonly]
  wire double target [writeonly]
  memory double[] trace
  memory uint8[*] grid [readonly]
  objref Tool{string} tools
end
)";

/// Two users with one password.
class TwoUsers final : public Users {
 public:
  [[nodiscard]] User authenticate(const std::string& name,
                                  const std::map<std::string, VarValue>& credentials,
                                  const NodeId&) const override {
    const auto password = credentials.find("password");
    if ((name == "operator" || name == "gateway") && password != credentials.end() &&
        password->second.get<std::string>() == "open sesame") {
      return name == "operator" ? User{name, {"objectlock"}} : User{name};
    }
    throw Error(ErrorCode::authentication_error, "not this one");
  }
};

/// Serves it at a port of this machine, in this process.
class BenchService {
 public:
  /// At a port that is free, unless one is named.
  explicit BenchService(const std::string& definition = bench_definition, std::uint16_t port = 0)
      : definitions_({definition}),
        bench_(definitions_, "test.bench.Bench"),
        tool_(definitions_, "test.bench.Tool") {
    bench_.store("speed", 0.5);
    bench_.store("mode", "slow");
    bench_.store("secret", 7);
    bench_.store("pose", dynamic::Value::record({{"x", 1.5}, {"q", dynamic::List{1, 2}}}));
    add_functions();
    add_generators();
    add_streams();
    add_tool();
    bench_.set_monitor(
        [this](std::chrono::milliseconds timeout) { return monitor_.try_acquire_for(timeout); },
        [this] { monitor_.release(); });
    bench_.store_memory("trace", std::vector<double>{0, 1, 2, 3, 4, 5, 6, 7});
    bench_.store_memory("grid", grid());
    port_ = node_.listen_tcp(port);
    ServiceOptions options;
    options.users = std::make_shared<TwoUsers>();
    options.attributes = {{"place", VarValue(std::string("bench 4"))}};
    service_.emplace(dynamic::register_service(node_, "bench", bench_, options));
  }

  /// How many clients are connected, gateways included.
  [[nodiscard]] std::size_t client_count() const { return (*service_)->clients().size(); }
  /// The object at a path is released: `tools[left%20hand]`.
  void release(const std::string& path) { (*service_)->release_path("bench." + path); }
  /// Ends the service.
  void close() { (*service_)->close(); }
  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] std::string url() const {
    return "rr+tcp://localhost:" + std::to_string(port_) + "/?service=bench";
  }
  [[nodiscard]] const dynamic::ServedObject& bench() const { return bench_; }
  [[nodiscard]] const dynamic::ServedObject& tool() const { return tool_; }
  /// How generators were ended by clients: `closed`, `aborted`.
  Kept<std::string> ended;
  /// What `collect` has taken.
  Kept<double> collected;
  /// What clients have sent to `commands`, and closed endpoints as `end`.
  Kept<std::string> commands;
  /// What clients have sent to `both`.
  Kept<std::uint32_t> both;
  /// How often `count` was executed.
  [[nodiscard]] int counted() const { return count_; }

 private:
  void add_functions() {
    bench_.on_call("add", [](const dynamic::List& arguments) {
      return arguments[0].as<double>() + arguments[1].as<double>();
    });
    bench_.on_call("describe", [](const dynamic::List& arguments) {
      return arguments[0].text() + " at " + std::to_string(arguments[1]["x"].as<double>());
    });
    bench_.on_call("fail", [](const dynamic::List& arguments) -> dynamic::Value {
      const std::string text = arguments[0].text();
      if (text == "invalid endpoint") throw Error(ErrorCode::invalid_endpoint, text);
      throw Error(ErrorCode::remote_error, "test.bench.Jam", text);
    });
    bench_.on_call("whoami", [](const dynamic::List&) {
      const auto user = ServiceContext::current_user();
      return user ? user->name : std::string("nobody");
    });
    bench_.on_call("count", [this](const dynamic::List&) { return ++count_; });
  }
  // Each client has its own.
  void add_generators() {
    bench_.on_generate("count_to", [this](const dynamic::List& arguments) {
      const auto at = std::make_shared<std::atomic<int>>(0);
      return dynamic::Steps(
          [at,
           last = arguments[0].as<int>()](const dynamic::Value&) -> std::optional<dynamic::Value> {
            if (last < 0) throw Error(ErrorCode::remote_error, "test.bench.Jam", "no way down");
            if (*at == last) return std::nullopt;
            return dynamic::Value(static_cast<double>(++*at));
          },
          [this](bool aborts) { ended.add(aborts ? "aborted" : "closed"); });
    });
    bench_.on_generate("collect", [this](const dynamic::List&) {
      return dynamic::Steps(
          [this](const dynamic::Value& value) -> std::optional<dynamic::Value> {
            collected.add(value.as<double>());
            return dynamic::Value();
          },
          [this](bool aborts) { ended.add(aborts ? "aborted" : "closed"); });
    });
    bench_.on_generate("sums", [](const dynamic::List& arguments) {
      const auto sum = std::make_shared<std::atomic<double>>(arguments[0].as<double>());
      return dynamic::Steps([sum](const dynamic::Value& value) -> std::optional<dynamic::Value> {
        *sum = *sum + value.as<double>();
        return dynamic::Value(sum->load());
      });
    });
  }
  void add_streams() {
    bench_.pipe("commands").on_connect([this](dynamic::PipeEndpoint end) {
      end.on_packet([this](const dynamic::Value& packet) { commands.add(packet.text()); }).detach();
      end.on_closed([this] { commands.add("end"); });
    });
    bench_.pipe("both").on_connect([this](dynamic::PipeEndpoint end) {
      end.on_packet([this](const dynamic::Value& packet) { both.add(packet.as<std::uint32_t>()); })
          .detach();
    });
  }
  /// 20 x 30 bytes, in the order of memory, the first index fastest: 0 to 250, again and again.
  static dynamic::Value grid() {
    MultiArray<std::uint8_t> array;
    array.dims = {20, 30};
    std::vector<std::uint8_t> items(600);
    for (std::size_t i = 0; i < items.size(); ++i) items[i] = static_cast<std::uint8_t>(i % 251);
    array.items = Array<std::uint8_t>(items);
    return array;
  }
  void add_tool() {
    tool_.store("width", 2.5);
    tool_.on_call("open", [tool = dynamic::WeakServedObject(tool_)](const dynamic::List&) {
      tool.lock().fire("opened", {1});
      return dynamic::Value();
    });
    bench_.on_object("tools", [this](const dynamic::Value& index) -> std::shared_ptr<Skeleton> {
      if (index.text() != "left hand") return nullptr;
      return tool_;
    });
  }

  dynamic::Definitions definitions_;
  dynamic::ServedObject bench_;
  dynamic::ServedObject tool_;
  std::atomic<int> count_{0};
  std::binary_semaphore monitor_{1};
  Node node_;
  std::uint16_t port_ = 0;
  std::optional<Service> service_;
};

}  // namespace rr::gateway::testing
