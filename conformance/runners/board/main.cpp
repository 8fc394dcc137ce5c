// SPDX-License-Identifier: Apache-2.0
// The runner of boards, `serve` only: the sketch of the folder on a simulated board, behind a
// bridge by TCP. A folder whose definitions do not fit a board has no sketch: every request is
// answered with the reason.
//   conformance_board_runner PROGRAM.elf serve
//   conformance_board_runner --refused REASON serve
#include <iostream>
#include <memory>
#include <rr/node.hpp>
#include <rr/serial.hpp>
#include <stdexcept>
#include <string>

#include "conformance/harness/json.hpp"
#include "conformance/runners/shared/answer_lines.hpp"
#include "conformance/runners/shared/node_settings.hpp"
#include "runtime/arduino/bench/plugged_board.hpp"

namespace {

using rr::conformance::Json;

constexpr std::chrono::seconds patience{20};

class ServedBoard {
 public:
  explicit ServedBoard(std::string elf) : elf_(std::move(elf)) {}

  Json answer(const Json& request) {
    const std::string what = request.at("do");
    if (what == "start") return start(request);
    if (what != "close_service") throw std::runtime_error("unknown request " + what);
    bridge_.reset();
    return {{"done", true}};
  }

 private:
  Json start(const Json& request) {
    bridge_.reset();
    node_ = std::make_unique<rr::Node>(rr::conformance::node_options(request));
    board_ = std::make_unique<rr::serial::testing::PluggedBoard>(elf_);
    bridge_ = std::make_unique<rr::BoardBridge>(*node_);
    bridge_->add({.path = board_->path(), .name = request.at("services").at(0).at("name")});
    if (!bridge_->wait(patience)) throw std::runtime_error("the board does not answer");
    const auto port = static_cast<std::uint16_t>(request.value("port", 0));
    return {{"port", node_->listen_tcp(port, "127.0.0.1")}};
  }

  const std::string elf_;
  std::unique_ptr<rr::serial::testing::PluggedBoard> board_;
  std::unique_ptr<rr::Node> node_;
  std::unique_ptr<rr::BoardBridge> bridge_;
};

}  // namespace

int main(int argc, char** argv) {
  const bool is_refused = argc == 4 && std::string(argv[1]) == "--refused";
  if ((argc != 3 && !is_refused) || std::string(argv[argc - 1]) != "serve") {
    std::cerr << "usage: conformance_board_runner PROGRAM.elf|--refused REASON serve\n";
    return 2;
  }
  ServedBoard board(argv[1]);
  rr::conformance::answer_lines([&](const Json& request) {
    if (is_refused) throw std::runtime_error(argv[2]);
    return board.answer(request);
  });
  return 0;
}
