// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "rr/reader.hpp"
#include "rr/registry.hpp"
#include "rr/writer.hpp"
#include "runtime/cpp/src/channel/account.hpp"
#include "runtime/cpp/src/endpoint/pipe_packets.hpp"
#include "runtime/cpp/src/endpoint/pipe_state.hpp"

namespace rr::endpoint {

/// An entry of packets on its way to the endpoints: taken first, then acknowledged in one message,
/// then delivered, which runs user code.
class PipeArrival {
 public:
  using End = std::shared_ptr<PipeEnd::State>;
  /// Who gets a packet: an end, or somebody else who has it now, or nobody.
  struct Taken {
    End end;
    bool is_taken = false;
  };

  /// What the packets of an entry may take in memory.
  struct Room {
    std::shared_ptr<channel::Account> account{};  ///< what is drawn on while one is decoded
    std::size_t containers = Decoder::container_limit;

    /// Whether it has to be counted: a decoder has the usual limit of itself.
    [[nodiscard]] bool is_limited() const {
      return account != nullptr || containers != Decoder::container_limit;
    }
  };

  PipeArrival(const Message& message, const Entry& entry, const MemoryRef& owner,
              const TypeRegistry& types, Room room)
      : entry_(entry),
        message_size_(message.entries.size()),
        decoder_(message.version, &message.strings, owner, &types),
        room_(std::move(room)) {}

  /// Asks `find(packet, decoder)` for each packet. Those for nobody, and those of another type, are
  /// dropped without a word.
  template <class Find>
  void take(const Find& find) {
    PipePacketReader packets(decoder_, entry_);
    for (PipePacket packet; packets.next(packet);) {
      Taken taken = find(packet, decoder_);
      if (!taken.is_taken) continue;
      if (!taken.end || hand_to(std::move(taken.end), packet)) acknowledge(packet);
    }
  }

  [[nodiscard]] bool has_acknowledgements() const { return !acknowledged_.empty(); }
  /// Writes their elements; returns how many.
  std::uint32_t write_acknowledgements(Writer& writer) const;
  /// Metadata of the message with them.
  [[nodiscard]] std::string_view metadata() const {
    return is_unreliable_ ? unreliable_metadata : std::string_view();
  }
  /// Runs what waits for the packets; closes ends whose queue was full.
  void deliver();

 private:
  bool hand_to(End end, const PipePacket& packet);
  void acknowledge(const PipePacket& packet) {
    if (packet.asks_acknowledgement) acknowledged_.emplace_back(packet.index, packet.number);
  }

  const Entry& entry_;
  const std::size_t message_size_;
  Decoder decoder_;
  const Room room_;
  bool is_unreliable_ = false;
  std::vector<std::pair<std::int32_t, std::uint32_t>> acknowledged_;
  End last_;  // the end of the packet before, which is nearly always the only one
  std::vector<End> others_;
  std::vector<End> full_;
};

/// Calls `function(index, number)` for each acknowledgement of an entry.
void for_each_acknowledgement(const Message& message, const Entry& entry,
                              const std::function<void(std::int32_t, std::uint32_t)>& function);

}  // namespace rr::endpoint
