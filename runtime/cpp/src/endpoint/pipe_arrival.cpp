// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/endpoint/pipe_arrival.hpp"

#include <optional>

#include "rr/type.hpp"

namespace rr::endpoint {
namespace {

// Measures what the containers of a packet take.
class PacketMemory final : public ContainerBudget {
 public:
  explicit PacketMemory(const PipeArrival::Room& room)
      : limit_(room.containers), charge_(room.account) {}
  bool draw(std::size_t bytes) override {
    return bytes_ <= limit_ && bytes <= limit_ - bytes_ && charge_.add(bytes) && add(bytes);
  }
  [[nodiscard]] std::size_t bytes() const { return bytes_; }
  /// The packet is drawn for by its end from now on.
  void clear() { charge_.clear(); }

 private:
  bool add(std::size_t bytes) {
    bytes_ += bytes;
    return true;
  }

  const std::size_t limit_;
  channel::Charge charge_;
  std::size_t bytes_ = 0;
};

}  // namespace

// False when the packet is not to be acknowledged.
[[gnu::hot]] bool PipeArrival::hand_to(End end, const PipePacket& packet) {
  const PipeEnd::State::Identity& what = end->identity;
  is_unreliable_ = what.is_unreliable;
  if (!end->may_receive()) return true;
  std::shared_ptr<void> value = what.holding->make();
  // A small part of a message is not to keep all of it.
  const bool is_most = packet.size >= message_size_ / 2;
  Decoder decoder(decoder_.version(), decoder_.strings(), is_most ? decoder_.owner() : MemoryRef(),
                  decoder_.types());
  std::optional<PacketMemory> memory;
  if (room_.is_limited()) decoder.set_budget(memory.emplace(room_));
  if (!what.member->type->read(decoder, packet.value, value.get())) return false;
  if (memory) memory->clear();
  if (!end->accept(packet.number, std::move(value), packet.size, memory ? memory->bytes() : 0)) {
    full_.push_back(end);
  }
  if (last_ != end) {
    if (last_) others_.push_back(std::move(last_));
    last_ = std::move(end);
  }
  return true;
}

std::uint32_t PipeArrival::write_acknowledgements(Writer& writer) const {
  for (auto each = acknowledged_.rbegin(); each != acknowledged_.rend(); ++each) {
    write_acknowledgement(writer, each->first, each->second);
  }
  return static_cast<std::uint32_t>(acknowledged_.size());
}

[[gnu::hot]] void PipeArrival::deliver() {
  for (const End& end : others_) end->deliver();
  if (last_) last_->deliver();
  for (const End& end : full_) {
    if (const auto side = end->side()) side->close(*end, false);
  }
}

void for_each_acknowledgement(const Message& message, const Entry& entry,
                              const std::function<void(std::int32_t, std::uint32_t)>& function) {
  Decoder decoder(message.version, &message.strings);
  ElementReader elements(decoder, entry.elements, entry.element_count);
  for (Element element; elements.next(element);) {
    const auto index = element.index();
    std::uint32_t number = 0;
    if (index && read_number(element, number)) function(*index, number);
  }
}

}  // namespace rr::endpoint
