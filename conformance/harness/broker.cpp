// SPDX-License-Identifier: Apache-2.0
#include "conformance/harness/broker.hpp"

#include <chrono>
#include <cstdlib>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <vector>

#include "conformance/harness/stream.hpp"

namespace rr::conformance {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds broker_start_limit{20};
constexpr std::chrono::milliseconds broker_pause{5};

int free_port() { return Listener(0).port(); }

fs::path temporary_folder() {
  std::string name = (fs::temp_directory_path() / "rr-conformance-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make a folder");
  return name;
}

// Servers are outside of the paths of ordinary users.
std::string found(const char* name) {
  for (const char* folder : {"/usr/sbin/", "/usr/local/sbin/", "/usr/bin/", "/usr/local/bin/"}) {
    if (fs::exists(folder + std::string(name))) return folder + std::string(name);
  }
  throw std::runtime_error(std::string(name) + " is not installed");
}

void wait_until_it_listens(int port) {
  const auto deadline = std::chrono::steady_clock::now() + broker_start_limit;
  for (;;) {
    try {
      static_cast<void>(Stream::connect("127.0.0.1", port));
      return;
    } catch (const std::runtime_error&) {
      if (std::chrono::steady_clock::now() > deadline) throw;
    }
    std::this_thread::sleep_for(broker_pause);
  }
}

}  // namespace

bool is_over_broker(std::string_view channel) { return channel == "mqtt" || channel == "nats"; }

Broker::Broker(std::string_view channel) : folder_(temporary_folder()) {
  const int port = free_port();
  const std::string number = std::to_string(port);
  std::vector<std::string> words;
  if (channel == "mqtt") {
    // Without a file of settings it listens on the loopback interface, for everybody.
    words = {found("mosquitto"), "-p", number};
  } else {
    words = {found("nats-server"),        "-a", "127.0.0.1", "-p", number, "-js", "-sd",
             (folder_ / "store").string()};
  }
  program_ = std::make_unique<Program>(std::move(words), folder_ / "broker.log");
  wait_until_it_listens(port);
  url_ = std::string(channel) + "://127.0.0.1:" + number;
}

Broker::~Broker() {
  program_.reset();
  std::error_code error;
  fs::remove_all(folder_, error);
}

fs::path Broker::new_folder() {
  const fs::path made = folder_ / ("gateways" + std::to_string(++names_));
  fs::create_directory(made);
  return made;
}

}  // namespace rr::conformance
