// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>

#include "rr/wires.hpp"
#include "runtime/cpp/src/endpoint/wire_end.hpp"

namespace rr {

class Session;

namespace client {

/// A client's end of a wire.
class ClientWireEnd final : public WireEnd::State {
 public:
  ClientWireEnd(std::shared_ptr<Session> session, std::string path, const Member& member);

  void close() override;
  /// The service has answered that it is connected. From the thread that reads the answer.
  void take_answer();
  /// Whether a notice that its object was released is of this end, and of none before it.
  [[nodiscard]] bool is_meant_by(std::uint64_t notice) const { return notices_before_ < notice; }
  /// It could not be connected.
  void give_up();

 private:
  [[nodiscard]] channel::Connection& connection() const override;
  void check_sending() const override;
  endpoint::SenderTime draw_time() override { return times_.draw(core().clock()); }
  void transmit(Writer& writer, const channel::Newest& newest) override;

  const std::shared_ptr<Session> session_;
  endpoint::SenderTimes times_;
  // See Notices. What is handled before the answer has come does not mean this end.
  std::atomic<std::uint64_t> notices_before_ = std::numeric_limits<std::uint64_t>::max();
};

}  // namespace client
}  // namespace rr
