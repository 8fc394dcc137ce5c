// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>

#include "rr/reader.hpp"
#include "runtime/cpp/src/channel/connection.hpp"
#include "runtime/cpp/src/channel/slot_budget.hpp"
#include "runtime/cpp/src/endpoint/slot_terms.hpp"
#include "runtime/cpp/src/endpoint/wire_table.hpp"

namespace rr::service {

class OfferedWire;
class ServedWireEnd;
class ServerEndpoint;
struct Question;
struct ServedObject;

/// The wires of one client (07, section 13).
class Wires {
 public:
  explicit Wires(ServerEndpoint& endpoint);

  /// Answers a request, or takes a packet that could not be taken at once. Throws rr::Error, and
  /// what the program throws.
  void answer(const Question& question);
  /// A packet, where it is read. False when it is not of a connected wire.
  bool take(const Message& message, const Entry& entry, const MemoryRef& owner,
            channel::DeferredCallbacks& deferred);
  void remove(const WireEnd::State& end) { table_.remove(end); }
  /// What the memories are counted in whose slots this client reads.
  [[nodiscard]] const std::shared_ptr<channel::SlotBudget>& slot_budget() const {
    return slot_budget_;
  }
  /// Slots may not be for all any more.
  void renew_slots();
  [[nodiscard]] std::size_t count() const { return table_.size(); }
  /// Ends those for which `is_over(path, member)` holds, and tells the client. Returns how many.
  using Choice = std::function<bool(std::string_view, std::string_view)>;
  std::size_t end_if(const Choice& is_over);
  /// An object and those below it are forgotten.
  void release(std::string_view path);
  /// The client is gone.
  void end_all(channel::DeferredCallbacks& deferred);

 private:
  void answer_connected(const Question& question, const endpoint::SlotTerms& slots);
  bool answer_change(const Question& question, const ServedObject& object, const Member& member);
  void answer_packet(const Question& question, const ServedObject& object, const Member& member);
  void answer_connect(const Question& question, std::shared_ptr<const ServedObject> object,
                      const Member& member);
  std::shared_ptr<ServedWireEnd> connect(const Question& question,
                                         const std::shared_ptr<const ServedObject>& object,
                                         const Member& member, endpoint::SlotTerms& slots);
  void answer_disconnect(const Question& question, const ServedObject& object,
                         const Member& member);
  void answer_peek(const Question& question, const ServedObject& object, const Member& member);
  void answer_poke(const Question& question, const ServedObject& object, const Member& member);

  ServerEndpoint& endpoint_;
  endpoint::WireTable table_;
  const std::shared_ptr<channel::SlotBudget> slot_budget_;
};

}  // namespace rr::service
