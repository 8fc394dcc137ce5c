// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <cstdio>
#include <future>
#include <rr/node.hpp>
#include <string>

#include "example/gate.hpp"
#include "packet_channel.hpp"

namespace gate = example::gate;

class Gate final : public gate::GateDefault {
 public:
  std::string echo(const std::string& text) override {
    moved(1.5);
    return text;
  }
};

int main() {
  const auto packets = std::make_shared<PacketChannel>();
  rr::Node server({.channels = {{"packets", packets}}});
  server.register_service("gate", std::make_shared<Gate>());
  const std::string place = "packets://gate" + std::to_string(getpid());
  server.listen(place);

  rr::Node client({.channels = {{"packets", packets}}});
  auto stub = client.connect<gate::GateStub>(place + "/?service=gate");
  std::promise<double> moved;
  const rr::Subscription told = stub->moved().connect([&](double at) { moved.set_value(at); });
  stub->set_height(0.25);
  const std::string text(60'000, 'x');
  const bool is_same = stub->echo(text) == text;
  std::string refused = "nothing";
  try {
    stub->echo(std::string(200'000, 'x'));
  } catch (const rr::Error& error) {
    refused = error.name();
  }
  std::printf("height %.2f, echo %s, moved %.1f, too large: %s\n", stub->get_height(),
              is_same ? "same" : "other", moved.get_future().get(), refused.c_str());
  return 0;
}
