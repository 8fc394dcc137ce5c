// SPDX-License-Identifier: Apache-2.0
#pragma once

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
  /// It could not be connected.
  void give_up();

 private:
  [[nodiscard]] channel::Connection& connection() const override;
  void check_sending() const override;
  endpoint::SenderTime draw_time() override { return times_.draw(core().clock()); }
  void transmit(Writer& writer, const channel::Newest& newest) override;

  const std::shared_ptr<Session> session_;
  endpoint::SenderTimes times_;
};

}  // namespace client
}  // namespace rr
